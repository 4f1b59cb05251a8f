"""Lessons of the playground do not lie; whatever is changed can be undone; agents drive while their map is drawn. check.py runs this."""
import json
import math
import re
import subprocess

from hands import ROWS, SLEEP, TOP, choose, drag, drag_line, of_tool, same, wait

REGIONS = ROWS.format("pcr.pcr_regions(), 10")
# Times and the middles of the lengths that agent 1 may not have, by one region.
MIDDLES = "answers.map.map(([place, , lo, hi]) => [answers.first + place * step(), (lo + hi) / 2])"
REACHED = "$('reached').checkVisibility({ visibilityProperty: true })"


def metres(browser, kind, x, y, touch, last=False):
    zoom = browser.value("(() => { const p = $('plane'); frame(p.clientWidth, p.clientHeight); return view.zoom; })()")
    drag(browser, kind, (x * zoom, -y * zoom), touch, last=last)


# What each lesson says to drag, that far, times a factor as nobody measures it.
DRAGS = {
    "diagonal": lambda browser, touch, part: metres(browser, "start", 2 * part, 0, touch),
    "delay": lambda browser, touch, part: drag_line(browser, 2 * part, touch),
    "opposite": lambda browser, touch, part: metres(browser, "start", 0, 1 * part, touch),
    "tangent": lambda browser, touch, part: metres(browser, "start", 0, -0.2 * part, touch),
    "rectangle": lambda browser, touch, part: metres(browser, "leg", 0, 1.5 * part, touch, last=True),
}

# What each lesson says in figures: those that the claims below prove, and that DRAGS drags.
FIGURES = {"diagonal": ["0.5 m/s", "0.5 m", "2 m"], "delay": ["2 s"], "opposite": ["1 m", "0.6 m"], "tangent": ["0.45 m", "0.6 m", "0.2 m", "0.6 m"],
           "rectangle": ["1.6 m", "0.6 m", "5 cm", "1.5 m"]}


def begin(browser, name):
    browser.value(f"startLesson(LESSONS.findIndex((lesson) => lesson.name === '{name}')); 0")


def changed(browser, change, asked):
    """An answer after a change of the scenario."""
    return browser.value(f"(() => {{ {change}; update(); return {asked}; }})()")


def slopes(browser, early, late):
    """How fast the region of agent 1 rises, between two times [m/s]."""
    rows = [row for row in browser.value(MIDDLES) if early <= row[0] <= late]
    return [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(rows, rows[1:])]


def diagonal(browser, tool, folder):
    rising = slopes(browser, 1.1, 3.2)
    yield "0.5 m/s", browser.value("scenario.agents[1].v_max") == 0.5
    yield "rises by the speed of agent 2", len(rising) > 50 and all(abs(slope - 0.5) < 1e-9 for slope in rising)
    yield "agent 1 does not catch up as it opens", not of_tool(tool, folder, browser)[1]
    DRAGS["diagonal"](browser, False, 1)
    yield "they collide", len(of_tool(tool, folder, browser)[1]) == 1
    yield "the line is inside the region then", browser.value("""(() => { const [, , from, to] = answers.conflicts[0], t = (from + to) / 2;
      const [l] = rows(pcr.pcr_track(0, t, 0, 1), 1)[0]; return rows(pcr.pcr_map(0, t, 0, 1), 4).some(([, , lo, hi]) => lo < l && l < hi); })()""")


def delay(browser, tool, folder):
    before = [row for row in browser.value(REGIONS) if row[0] == 0]
    yield "both are at the crossing at the same time", len(of_tool(tool, folder, browser)[1]) == 1
    DRAGS["delay"](browser, False, 1)
    yield "the region stays, to the bit", before == [row for row in browser.value(REGIONS) if row[0] == 0] and len(before) == 1
    yield "agent 1 starts 2 s later", abs(browser.value("scenario.agents[0].t_start") - 2) < 0.05
    yield "no conflict", not of_tool(tool, folder, browser)[1]
    yield "agent 1 passes after agent 2", browser.value("(() => { const t = track().find(([, l]) => l >= 3)[0]; return rows(pcr.pcr_places(t), 6)[1][3] > 3.6; })()")
    begin(browser, "delay")
    browser.value("$('plan').click(); 0")
    yield "Plan delays finds a delay", any(browser.value("scenario.agents.map((agent) => agent.t_start)")) and not of_tool(tool, folder, browser)[1]


def opposite(browser, tool, folder):
    falling = slopes(browser, 2.7, 4.9)
    yield "the region falls", len(falling) > 50 and all(abs(slope + 1) < 1e-9 for slope in falling)
    yield "no delay helps", all(changed(browser, f"scenario.agents[{agent}].t_start = {late}", "answers.conflicts.length") for agent in (0, 1) for late in (0, 1, 3, 10, 60))
    begin(browser, "opposite")
    browser.value("$('plan').click(); 0")
    yield "Plan delays says why", browser.value("/^no plan: agents . and . meet however they move/.test($('said').textContent)")
    file = folder / "opposite.json"
    file.write_text(browser.value("JSON.stringify(scenario)"))
    yield "nor has the tool a plan", subprocess.run([tool, "plan", "-q", file], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode != 0
    counts = [changed(browser, f"scenario.agents[0].start.y = {y}", "answers.map.length") for y in (0.599, 0.601)]
    yield "the region is gone from 0.6 m on", counts[0] > 0 == counts[1]


def tangent(browser, tool, folder):
    near = browser.value("""(() => { const [a, b] = scenario.agents; let least = Infinity;
      for (let k = 0; k <= 2000; k++) least = Math.min(least, along(b, whole(b.path[0]) * k / 2000).y - a.start.y); return least; })()""")
    yield "0.45 m at the nearest point, no crossing", abs(near - 0.45) < 1e-5
    yield "there is a region all the same", len(of_tool(tool, folder, browser)[0]) == 2
    sizes = [changed(browser, f"scenario.agents[0].start.y = {y}", "rows(pcr.pcr_regions(), 10).filter((row) => row[0] === 0).map((row) => [row[3] - row[2], row[5] - row[4]])")
             for y in (0, -0.1, -0.149, -0.1499999, -0.150001)]
    yield "it shrinks to a point", [len(size) for size in sizes] == [1, 1, 1, 1, 0] and all(a[0][k] > b[0][k] for a, b in zip(sizes, sizes[1:4]) for k in (0, 1)) and max(sizes[3][0]) < 0.01
    begin(browser, "tangent")
    DRAGS["tangent"](browser, False, 1)
    late = [changed(browser, f"scenario.agents[0].t_start = {t}", "answers.conflicts.length") for t in range(8)]
    yield "the two cannot meet, whenever they start", not any(late) and not of_tool(tool, folder, browser)[0]


def rectangle(browser, tool, folder):
    sides = browser.value("[0, 1].map((axis) => { const all = polygon(scenario.agents[0]).map((corner) => corner[axis]); return Math.max(...all) - Math.min(...all); })")
    yield "1.6 m by 0.6 m", sides == [1.6, 0.6]
    yield "nothing as it opens", not any(of_tool(tool, folder, browser))
    counts = [changed(browser, f"startLesson(lesson); scenario.agents[1].start.y += {up}", "answers.map.length") for up in (0.049, 0.051)]
    yield "5 cm beside its way", counts[0] == 0 < counts[1]
    begin(browser, "rectangle")
    DRAGS["rectangle"](browser, False, 1)
    yield "the path turns left", browser.value("scenario.agents[0].path[1].sweep") > 0.5
    rows = browser.value("answers.map")
    yield "a region at all times", [row[0] for row in rows] == list(range(browser.value("COLUMNS + 1"))) and len({tuple(row[2:]) for row in rows}) == 1
    yield "they collide", len(of_tool(tool, folder, browser)[1]) == 1
    # The corner that touches first is behind the reference point: the line there was free of it.
    yield "a corner at the rear", browser.value("""(() => { const [, , from] = answers.conflicts[0], [x, y, heading] = rows(pcr.pcr_places(from), 6)[0];
      const { x: u, y: v } = scenario.agents[1].start; return (u - x) * Math.cos(heading) + (v - y) * Math.sin(heading) < 0; })()""")
    begin(browser, "rectangle")
    browser.value("$('shape').value = 'disc'; $('shape').dispatchEvent(new Event('change', { bubbles: true })); 0")
    yield "a disc around it collides on the line already", len(of_tool(tool, folder, browser)[1]) == 1


CLAIMS = {"diagonal": diagonal, "delay": delay, "opposite": opposite, "tangent": tangent, "rectangle": rectangle}


def lessons(tool, folder, browser):
    """Every lesson: short, not reached as it opens, reached by what it says to drag, and right."""
    wrong, names = [], browser.value("LESSONS.map((lesson) => lesson.name)")
    if names != list(CLAIMS) or names != list(DRAGS):
        wrong.append(f"lessons {names}, of which {list(CLAIMS)} are proved")
    count = 0
    for name in names:
        for part in (0.85, 1, 1.15):
            begin(browser, name)
            sentences = browser.value("$('why').innerText.split(/[.?!](?:\\s|$)/).filter(Boolean).length")
            figures = re.findall(r"[\d.]+ (?:m/s|cm|m|s)\b", browser.value("$('taught').textContent"))
            wrong += [] if figures == FIGURES[name] else [f"{name} says {figures}, of which {FIGURES[name]} are proved"]
            wrong += [] if 2 <= sentences <= 4 else [f"{name}: {sentences} sentences"]
            wrong += [f"{name} is reached as it opens"] if browser.value(REACHED) else []
            DRAGS[name](browser, False, part)
            wrong += [] if browser.value(REACHED) else [f"{name}: not reached by {part} of what it says"]
            wrong += [] if browser.value("$('lesson').selectedOptions[0].text === LESSONS[lesson].title && !$('taught').hidden") else [f"{name}: it is not shown"]
        browser.value("$('taught').scrollIntoView(); 0")
        browser.screenshot(folder / f"lesson-{name}.png")
        wrong += same(tool, folder, browser, f"lesson {name}")
        browser.value("$('undo').click(); 0")
        wrong += [f"{name} stays reached when its drag is undone"] if browser.value(REACHED) else []
        begin(browser, name)
        for claim, holds in CLAIMS[name](browser, tool, folder):
            count += 1
            wrong += [] if holds else [f"lesson {name}: not so: {claim}"]
    browser.value("$('next').click(); 0")
    wrong += [] if browser.value("LESSONS[lesson].name") == names[0] else ["the lesson after the last is not the first"]
    browser.value("$('lesson').value = -1; $('lesson').dispatchEvent(new Event('change', { bubbles: true })); 0")
    wrong += [] if browser.value("$('taught').hidden && scenario.agents.length === 2") else ["without a lesson, one is shown, or its agents are gone"]
    print(f"{len(names)} lessons, {count} claims")
    return wrong


def by_finger(folder, browser):
    """The lessons at 390 px: what they say to drag can be dragged by a finger, and nothing is wider than the window."""
    wrong = []
    # What a finger has thrown before goes on for a while.
    place = lambda: browser.value("scrollY")
    if not wait(browser, lambda: place() == (browser.value(SLEEP.format(150)), place())[1]):
        wrong.append("the page scrolls on and on")
    # A long text above the plane becomes a short one: what is dragged stays at the finger.
    browser.value("open(START); $('plan').click(); 0")
    before = browser.value("[scenario.agents[0].start, frame($('plane').clientWidth, $('plane').clientHeight) && view.zoom, $('said').offsetHeight]")
    drag(browser, "start", (-40, 0), touch=True)
    after = browser.value("[scenario.agents[0].start, $('said').offsetHeight]")
    # Fingers are told in whole pixels.
    if after[1] > before[2] - 10 or max(abs(after[0]["y"] - before[0]["y"]), abs(before[0]["x"] - after[0]["x"] - 40 / before[1])) > 2 / before[1]:
        wrong.append(f"a drag under a text that becomes shorter goes from {before} to {after}")
    for name in DRAGS:
        begin(browser, name)
        browser.value(SLEEP.format(50))
        DRAGS[name](browser, True, 1)
        wrong += [] if browser.value(REACHED) else [f"{name}: not reached by a finger"]
        wide = browser.value("document.documentElement.scrollWidth")
        wrong += [f"lesson {name}: {wide} px wide"] if wide > 390 else []
        browser.value("$('taught').scrollIntoView(); 0")
        browser.screenshot(folder / f"lesson-{name}-390.png")
    return wrong


def undoing(folder, browser):
    """Changes of every kind, undone one by one and done again."""
    wrong = []
    event = lambda target, kind: f"{target}.dispatchEvent(new Event('{kind}', {{ bubbles: true }}))"
    typed = lambda field, text: f"(() => {{ const f = document.querySelector('[aria-label=\"{field}\"]'); f.value = '{text}'; {event('f', 'input')}; {event('f', 'change')}; }})()"
    run = lambda script: lambda: browser.value(f"{script}; 0")
    click = lambda button: run(f"$('{button}').click()")

    def slide():
        for value in (0.2, 0.3, 0.4):
            browser.value(f"(() => {{ const s = document.querySelector('#sliders input'); s.value = {value}; {event('s', 'input')}; }})()")
        browser.value(f"(() => {{ const s = document.querySelector('#sliders input'); {event('s', 'change')}; }})()")

    def held():
        browser.value("$('plane').focus()")
        browser.key("ArrowUp")

    def load():
        (folder / "undo.json").write_text((TOP / "tests/data/paper12.json").read_text().replace("paper12", "loaded"))
        choose(browser, folder / "undo.json")
        wait(browser, lambda: browser.value("scenario.name") == "loaded")

    changes = {
        "dragging a start": lambda: drag(browser, "start", (30, 20), moves=8), "dragging a heading": lambda: drag(browser, "heading", (0, -30)),
        "dragging a leg": lambda: drag(browser, "leg", (40, -20)), "dragging the line": lambda: drag_line(browser, 1.5), "an arrow key": held, "a slider": slide,
        "a field": run(typed("Speed [m/s]", "0.75")), "a line": click("line"), "an arc": click("arc"), "a leg less": run("document.querySelector('#legs button').click()"),
        "a polygon": run(f"$('shape').value = 'polygon'; {event('$(`shape`)', 'change')}"), "a corner": click("corner"), "dragging a corner": lambda: drag(browser, "corner", (12, -8)),
        "an agent": click("add"), "an agent less": run("chosen = 2; edit(); $('remove').click()"), "a plan": run("open(START); $('plan').click()"), "all starts at 0": click("now"),
        "a lesson": run(f"$('lesson').value = 3; {event('$(`lesson`)', 'change')}"), "a file": load,
    }
    state = lambda: browser.value("({ scenario: JSON.stringify(scenario), colours: scenario.agents.map((_, k) => colour(k)), lesson, at: current, undo: !$('undo').disabled, redo: !$('redo').disabled, said: $('said').textContent })")
    browser.value("open(START); chosen = 0; edit(); update(); steps.length = 0; current = -1; remember(); 0")
    if state()["undo"] or state()["redo"]:
        wrong.append("there is something to undo before any change")
    states = [state()]
    for name, change in changes.items():
        change()
        browser.value(SLEEP.format(60))
        states.append(state())
        steps = states[-1]["at"] - states[-2]["at"]
        # A plan is made of the paper's agents, which are opened before.
        if steps != (2 if name == "a plan" else 1) or states[-1]["redo"] or not states[-1]["undo"]:
            wrong.append(f"{name} is {steps} changes")
    shown = ("scenario", "colours", "lesson")
    by_key = lambda key, modifiers: lambda: browser.key(key, modifiers=modifiers)
    for way, (back, forth) in {"buttons": (click("undo"), click("redo")), "keys": (by_key("z", 2), by_key("Z", 10)), "Ctrl+Y": (by_key("z", 2), by_key("y", 2))}.items():
        for name, act, there in [*((name, back, there) for name, there in zip(reversed(changes), states[-2::-1])), *((name, forth, there) for name, there in zip(changes, states[1:]))]:
            while state()["at"] != there["at"]:
                before = state()["at"]
                act()
                if state()["at"] == before:
                    break
            found = state()
            if any(found[part] != there[part] for part in shown) or found["undo"] != (there["at"] > 0) or found["redo"] != (there["at"] < states[-1]["at"]):
                wrong.append(f"{name} by {way}: {[part for part in shown if found[part] != there[part]]} differ")
    # What was typed and is not yet a change of its own is undone, the field keeps the focus, and a new change ends what could be done again.
    browser.value("open(START); 0")
    typing = typed("Speed [m/s]", "0.9").split("; f.dispatchEvent(new Event('change'")[0]
    browser.value("document.querySelector('[aria-label=\"Speed [m/s]\"]').focus()")
    browser.value(f"{typing}; }})()")
    browser.key("z", modifiers=2)
    where = browser.value("[JSON.stringify(scenario) === JSON.stringify(read(START)), document.activeElement.getAttribute('aria-label'), document.activeElement.value, !$('redo').disabled]")
    wrong += [] if where == [True, "Speed [m/s]", "0.58", True] else [f"what is typed is undone to {where}"]
    browser.value("$('add').click(); 0")
    wrong += [] if not state()["redo"] else ["after a new change, an old one can be done again"]
    # A drag that goes on is not undone in its middle.
    before = browser.value("grabbed = { kind: 'start' }; scenario.agents[0].start.x = 1; steps.length")
    browser.key("z", modifiers=2)
    wrong += [] if browser.value(f"(() => {{ const kept = scenario.agents[0].start.x === 1 && steps.length === {before}; grabbed = null; travel(-1); return kept; }})()") else ["a drag is undone in its middle"]
    for _ in range(3):
        browser.value("for (let k = 0; k < 100; k++) { scenario.agents[0].start.x += 0.001; remember(); } 0")
    wrong += [] if browser.value("steps.length === STEPS && current === STEPS - 1") else ["changes are kept without end"]
    print(f"{len(changes)} kinds of changes are undone and done again")
    return wrong


def driving(folder, browser):
    """Agents drive, and the map is drawn up to now; what the other forbids now is on the path, too."""
    wrong = []
    begin(browser, "diagonal")
    # How strong the region is, before now and after it.
    ink = lambda: browser.value("""(() => { const m = $('map'), pen = m.getContext('2d'), { px, py } = axes(m.clientWidth, m.clientHeight), found = [new Set(), new Set()];
      const scale = m.width / m.clientWidth, middles = answers.map.map(([place, , lo, hi]) => [px(answers.first + place * step()), py((lo + hi) / 2)]);
      pen.fill = (path) => { if (path) for (const [x, y] of middles)
        if (Math.abs(x - px(time)) > 4 && pen.isPointInPath(path, scale * x, scale * y)) found[Number(x > px(time))].add(pen.globalAlpha); };
      drawMap();
      delete pen.fill;
      return found.map((all) => [...all]); })()""")
    places = lambda: browser.value("rows(pcr.pcr_places(time), 6).map((place) => place[3])")
    browser.value("time = 0; $('play').click(); 0")
    if not wait(browser, lambda: browser.value("time") > 2):
        wrong.append("time does not go on")
    browser.screenshot(folder / "playground-driving.png")
    browser.value("requestAnimationFrame = ((before) => (act) => (requestAnimationFrame = before, 0))(requestAnimationFrame); 0")
    browser.value(SLEEP.format(100))
    here, faint = places(), ink()
    browser.value("$('play').click(); 0")
    full = ink()
    if not (0 < here[0] < 6 and 0 < here[1] < 5):
        wrong.append(f"agents are at {here} m")
    if not (len(full[0]) == 1 and full[0] == full[1] == faint[0] and len(faint[1]) == 1 and 0 < faint[1][0] < full[0][0] / 2):
        wrong.append(f"what was and what is to come are drawn as strong as {faint}, and {full} when time stands")
    # The stretch of the path that is drawn is that of the map.
    wrong += [] if browser.value("""(() => { const [[, , lo, hi]] = rows(pcr.pcr_map(0, time, 0, 1), 4), part = cut(scenario.agents[0], lo, hi);
      return Math.abs(part.start.x - (scenario.agents[0].start.x + lo)) < 1e-12 && Math.abs(part.path[0].length - (hi - lo)) < 1e-12; })()""") else ["a part of a path is another one"]
    bent = {"agents": [{"id": 1, "radius": 0.2, "v_max": 1, "a_max": 1, "start": {"x": 0, "y": 0, "heading": 0},
                        "path": [{"kind": "line", "length": 1}, {"kind": "arc", "radius": 1, "sweep": math.pi}, {"kind": "line", "length": 1}]}]}
    ends = browser.value(f"(() => {{ const [agent] = read({json.dumps(bent)}).agents; return [[0.5, 2], [1, 4], [1.5, 2.5], [0, 9]].map(([lo, hi]) => [joints(cut(agent, lo, hi)).at(-1), along(agent, hi)]); }})()")
    wrong += [] if all(abs(a[axis] - b[axis]) < 1e-9 for a, b in ends for axis in ("x", "y")) else [f"parts of a bent path end at {ends}"]
    return wrong
