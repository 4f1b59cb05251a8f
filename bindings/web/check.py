#!/usr/bin/env python3
"""check.py PCR PAGE FOLDER: opens the playground in headless Chromium, and fails unless

- nothing is written to the console, nothing asked of the network, nothing wider than windows of 390, 900 and 1400 px;
- the Tab key reaches every control; arrow keys move the start of an agent, with Shift its heading;
- a drag of a leg, of a start, by a finger at 390 px, too, and a slider change the scenario, and all regions and conflicts are then those of the tool PCR, bit for bit;
- legs that are dragged close to a tangent are lines, and headings close to a multiple of 45° are that, exactly;
- delays that the page plans leave no conflict for the tool;
- a saved file is the scenario, for the page and for the tool; plans that the tool writes are loaded, and what is no scenario is refused with a reason;
- what the tool refuses is refused, in files and in fields, and what it takes is taken, with the reason said and nothing of it drawn;
- a disc becomes a convex polygon, whose corners are dragged and added, and the tool says the same of it, bit for bit;
- an agent is removed, and the others keep their colours and can be edited;
- of every lesson, what it says to drag leads to what it says, and its figures are those of the tool;
- whatever changes the scenario is undone and done again, one drag as one change, by buttons and by keys;
- while time goes on, agents drive, and the map is drawn up to now;
- all of lessons, undoing and driving is so in Firefox, too;
- a link that is copied opens the scenario, in a new window and in one that shows the page.

Screenshots stay in FOLDER."""
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

from firefox import Firefox
from hands import SLEEP, TOP, choose, drag, finger, of_tool, ready, same, wait
from lessons import by_finger, driving, lessons, undoing
from pages import WIDTHS, Browser, reached_by_tab

ONE = {"agents": [{"id": 1, "radius": 0.2, "v_max": 1, "a_max": 1, "start": {"x": 0, "y": 0, "heading": 0}, "path": [{"kind": "line", "length": 2}]}]}


def snapping(browser):
    """Legs and headings close to where they snap, and one that is not."""
    wrong = []

    def dragged(kind, angle):
        """What is left of one agent when the end of its leg, or its heading, is dragged to an angle [°] as seen from its start."""
        browser.value(f"open({json.dumps(ONE)}); 0")
        pixels = browser.value("TIP") if kind == "heading" else browser.value("2 * view.zoom")
        turned = math.radians(angle)
        drag(browser, kind, (pixels * (math.cos(turned) - 1), -pixels * math.sin(turned)))
        return browser.value("scenario.agents[0]")

    # An arc from a tangent turns by twice the angle of its chord.
    for angle, sweep in ((1.2, 0), (-1.2, 0), (44, math.pi / 2), (-46, -math.pi / 2), (30, None)):
        leg = dragged("leg", angle)["path"][0]
        turn = leg.get("sweep", 0)
        if (abs(turn - math.radians(60)) > 0.05) if sweep is None else (turn != sweep or (leg["kind"] == "line") != (sweep == 0)):
            wrong.append(f"a leg dragged to {angle}° is {leg}")
    for angle, heading in ((45.5, math.pi / 4), (-89.5, -math.pi / 2), (20, None)):
        found = dragged("heading", angle)["start"]["heading"]
        if (abs(found - math.radians(20)) > 0.05) if heading is None else found != heading:
            wrong.append(f"a heading dragged to {angle}° is {math.degrees(found)}°")
    return wrong


def keys(browser):
    browser.value(f"open({json.dumps(ONE)}); $('plane').focus(); 0")
    for key, shift in (("ArrowRight", False), ("ArrowUp", False), ("ArrowUp", False), ("ArrowLeft", True)):
        browser.key(key, modifiers=8 if shift else 0)
    start = browser.value("scenario.agents[0].start")
    expected = {"x": 0.05, "y": 0.1, "heading": math.radians(5)}
    return [] if all(abs(start[name] - value) < 1e-12 for name, value in expected.items()) else [f"keys move the start to {start}"]


def load(browser, file):
    """What the page says to a file, also to the same one again, as whoever clicks on the field chooses it."""
    browser.value("say(''); $('load').dispatchEvent(new Event('click')); 0")
    choose(browser, file)
    wait(browser, lambda: browser.value("$('said').textContent"))
    return browser.value("$('said').textContent")


def files(tool, folder, browser):
    """Saves a scenario as a file, and loads files, among them those of the tool."""
    wrong, saved = [], folder / "saved"
    shutil.rmtree(saved, ignore_errors=True)
    saved.mkdir()
    browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(saved))
    browser.value("open(START); scenario.agents[3].radius = 0.3; update(); $('save').click(); 0")
    wait(browser, lambda: any(file.suffix == ".json" for file in saved.iterdir()))
    [file] = saved.iterdir()
    here = browser.value("scenario")
    if json.loads(file.read_text()) != here:
        wrong.append(f"{file.name} is not the scenario of the page")
    count = lambda path: len(json.loads(subprocess.run([tool, "check", path, "--json", "-q"], capture_output=True, text=True, check=False).stdout)["conflicts"])
    if not count(file) or count(file) != browser.value("answers.conflicts.length"):
        wrong.append(f"{file.name}: {count(file)} conflicts for the tool")
    browser.value("open(START); 0")
    said = load(browser, file)
    if browser.value("scenario") != here:
        wrong.append(f"{file.name} is loaded as another scenario: {said}")
    plan = saved / "plan.json"
    subprocess.run([tool, "plan", "-q", TOP / "tests/data/paper12.json", "-o", plan], check=True, stdout=subprocess.DEVNULL)
    said = load(browser, plan)
    starts = [agent.get("t_start", 0) for agent in json.loads(plan.read_text())["agents"]]
    if said != "No conflict." or starts != browser.value("scenario.agents.map((agent) => agent.t_start)") or not any(starts):
        wrong.append(f"a plan of the tool: {said}, starts {starts}")
    kept = browser.value("scenario")
    one = ONE["agents"][0]
    changed = lambda **fields: json.dumps({"agents": [one, dict(one, id=2, **fields)] if "id" not in fields else [one, dict(one, **fields)]})
    for text, reason in (("{", "Not loaded"), ("null", "no agents"), ('{"agents": [null]}', "not an object"), (changed(margin=0.1), '"margin" is not known here'),
                         (changed(start=dict(one["start"], z=1)), '"z" is not known here'), (changed(path=[{"kind": "line", "length": 1, "radius": 2}]), '"radius" is not known here'),
                         (changed(path=[None]), "only lines and arcs"), (changed(path=[{"kind": "turn", "sweep": 1}]), "only lines and arcs"),
                         (changed(id=1), "given twice"), (changed(id="a"), "others names"),
                         (changed(id=2**60 + 1), "no whole number"), (changed(id=-1), "no whole number"), (changed(id=None), "no whole number"),
                         (changed(label=5), "not a text"), (changed(radius="0.2"), "not a number"), (json.dumps({"agents": [one], "version": 2}), "version 2"),
                         (json.dumps({"agents": [one] * 25}), "there is room for 24")):
        (saved / "bad.json").write_text(text)
        said = load(browser, saved / "bad.json")
        if reason not in said or browser.value("scenario") != kept:
            wrong.append(f"{text}: {said}")
    return wrong


def refusals(tool, folder, browser):
    """Files that the tool takes or refuses are for the page what they are for the tool; what is refused replaces nothing."""
    wrong, file, one = [], folder / "judged.json", ONE["agents"][0]
    fleet = lambda more=(), **fields: {"agents": [dict(one, **fields)], **dict(more)}
    leg = lambda **fields: fleet(path=[one["path"][0], fields])
    arc = lambda radius, sweep: leg(kind="arc", radius=radius, sweep=sweep)
    start = lambda **fields: dict(one["start"], **fields)
    refused = ((fleet(path=[], radius=0.3, start=start(x=1000000000000000.25)), "agent 1, x: 1000000000000000.2"), (fleet(start=start(heading=-1.1e10)), "agent 1, heading"),
               (fleet(t_start=None), "t_start is not a number"), (fleet({"name": None}), "the name is not a text"), (fleet({"warnings": None}), "warnings"), (fleet({"warnings": [1]}), "warnings"),
               (fleet(id="12"), "could be taken for the number"), (fleet(id="+007"), "could be taken for the number"), (fleet(id="a\u0007"), "control character U+0007"), (fleet(id="x" * 201), "201 characters"),
               (fleet(id="a", label="b"), "its id is a text"), (fleet(label=None), "not a text"), (fleet(label="a\nb"), "control character U+000A"), (fleet(label="a\u202eb"), "U+202E"), (fleet(label="x" * 300), "300 characters"),
               (arc(-1, 1), "agent 1, leg 2, radius: -1 is out of range; allowed is above 0"), (arc(0, 1), "agent 1, leg 2, radius"), (arc(0, 0), "agent 1, leg 2, radius"), (leg(kind="line", length=-1), "agent 1, leg 2, length"),
               (fleet(radius=0), "agent 1, radius"), (fleet(radius=-0.2), "agent 1, radius"), (fleet(v_max=0), "agent 1, v_max"), (fleet(a_max=-1), "agent 1, a_max"), (fleet(t_start=1e10), "the motion takes"),
               (fleet(v_max=1e-10), "the motion takes"), (arc(1e10, 2), "m long"), (fleet(start=None), "not an object"))
    # The highest number that an id may have as text is one less than 2^64.
    taken = (fleet(id="18446744073709551616"), fleet(id="é" * 200), fleet(label="x" * 200), fleet(label=""), fleet({"name": ""}), fleet({"warnings": []}), fleet(t_start=-5), fleet(path=[]),
             leg(kind="line", length=0), arc(0.5, 0), arc(0.5, -0.0), arc(0.5, 10), arc(0.5, -20), arc(0.5, 6.283185307179587), arc(0.5, 6.2831853071796))
    status = lambda: subprocess.run([tool, "check", file, "-q"], capture_output=True, check=False).returncode
    browser.value("open(START); 0")
    kept, drawn = browser.value("scenario"), browser.value("$('plane').toDataURL()")
    for scenario, reason in refused:
        file.write_text(json.dumps(scenario))
        said = load(browser, file)
        if status() != 2 or not said.startswith("Not loaded: ") or reason not in said or browser.value("scenario") != kept or browser.value("$('plane').toDataURL()") != drawn:
            wrong.append(f"{file.read_text()}: the tool ends with {status()}, the page says {said}")
    for scenario in taken:
        file.write_text(json.dumps(scenario))
        said = load(browser, file)
        if status() != 0 or said != "No conflict." or browser.value("scenario.agents[0].path") != scenario["agents"][0]["path"]:
            wrong.append(f"{file.read_text()}: the tool ends with {status()}, the page says {said}")
    # More turns than there is room for.
    file.write_text(json.dumps(arc(0.5, 200)))
    said = load(browser, file)
    wrong += [] if "each turn of an arc counted" in said else [f"an arc of 32 turns: {said}"]
    # Two and four turns, of which one is hit by another agent, and no turn at all in the middle of a path that is.
    for sweep in (10, -20, 0):
        other = dict(one, id=2, start={"x": 2, "y": -2, "heading": math.pi / 2}, path=[{"kind": "line", "length": 5}])
        turning = arc(0.5, sweep)["agents"][0]
        turning["path"] = turning["path"] if sweep else [turning["path"][1], turning["path"][0], turning["path"][1], turning["path"][0]]
        browser.value(f"open({json.dumps({'agents': [turning, other]})}); 0")
        wrong += same(tool, folder, browser, f"an arc of {sweep} rad")
        wrong += [] if browser.value("answers.conflicts.length + answers.map.length") else [f"an arc of {sweep} rad has no region"]
        ways = browser.value("""(() => { const ways = [], pen = { beginPath() {}, moveTo() {}, lineTo() { ways.push("line"); }, arc() { ways.push("arc"); } };
          trace(pen, scenario.agents[0], ({ x, y }) => [x, y]); return ways; })()""")
        wrong += [] if ways.count("arc") == math.ceil(abs(sweep) / math.tau) else [f"an arc of {sweep} rad is drawn as {ways}"]
    # Far from the origin, where steps of the grid are lost in rounding.
    lines = browser.value("""(() => { open(START); const pen = $('plane').getContext('2d'), seen = view; let lines = 0;
      pen.stroke = () => { if (++lines > 5000) throw new Error(); };
      grabbed = {}; view = { ...view, x: 2 ** 54 };
      try { drawPlane(); } catch { lines = Infinity; }
      delete pen.stroke; grabbed = null; view = seen; draw(); return String(lines); })()""")
    wrong += ["the grid has no end far from the origin"] if lines == "Infinity" else []
    return wrong


def fields(browser):
    """What is typed into a field is taken, or told and not drawn; agents that are added have ids that the tool takes."""
    wrong = []
    typed = lambda field, text: (browser.value(f"(() => {{ const f = document.querySelector('[aria-label=\"{field}\"]'); f.value = '{text}'; f.dispatchEvent(new Event('input')); }})()"),
                                 browser.value(SLEEP.format(100)), browser.value("$('said').textContent"))[2]
    browser.value("open(START); chosen = scenario.agents.findIndex((agent) => agent.path.some((leg) => leg.kind === 'arc')); edit(); update(); 0")
    leg = browser.value("scenario.agents[chosen].path.findIndex((leg) => leg.kind === 'arc')") + 1
    agent, kept, drawn = browser.value("chosen") + 1, browser.value("scenario"), browser.value("$('plane').toDataURL()")
    for field, text, reason in ((f"Radius of leg {leg}", "-1", f"agent {agent}, leg {leg}, radius: -1"), (f"Radius of leg {leg}", "0", f"leg {leg}, radius"),
                                (f"Turn of leg {leg}", "", f"leg {leg}, sweep is not a number"), ("Radius [m]", "-0.1", f"agent {agent}, radius"), ("Speed [m/s]", "0", f"agent {agent}, v_max"),
                                ("Start x [m]", "1000000000000000.25", f"agent {agent}, x")):
        said = typed(field, text)
        if not said.startswith("Not taken: ") or reason not in said or browser.value("scenario") != kept or browser.value("$('plane').toDataURL()") != drawn:
            wrong.append(f"{text} in {field}: {said}")
        wrong += [] if browser.value(f"document.querySelector('[aria-label=\"{field}\"]').ariaInvalid") == "true" else [f"{field} is not marked"]
        browser.value("edit(); update(); 0")
    said = typed(f"Radius of leg {leg}", "-1"), typed(f"Radius of leg {leg}", "1.5")
    if said[1].startswith("Not") or browser.value(f"scenario.agents[chosen].path[{leg - 1}].radius") != 1.5:
        wrong.append(f"a radius that is mended: {said[1]}")
    # As in a file, an arc may have a turn of 0: it has no length then.
    said = typed(f"Turn of leg {leg}", "0")
    if said.startswith("Not") or browser.value(f"scenario.agents[chosen].path[{leg - 1}].sweep") != 0:
        wrong.append(f"an arc that does not turn: {said}")
    # Whatever else makes a scenario one that is refused: nothing of it is drawn.
    browser.value(f"open({json.dumps(ONE)}); scenario.agents[0].start.x = 1e13; update(); 0")
    blank = browser.value("!$('plane').getContext('2d').getImageData(0, 0, $('plane').width, $('plane').height).data.some((byte) => byte)")
    wrong += [] if blank and browser.value("$('said').classList.contains('wrong')") else ["what is refused is drawn"]
    named = {"agents": [dict(ONE["agents"][0], id="AGV-7"), dict(ONE["agents"][0], id="agent-1", start={"x": 0, "y": 5, "heading": 0})]}
    browser.value(f"open({json.dumps(named)}); $('add').click(); $('add').click(); 0")
    ids = browser.value("scenario.agents.map((agent) => agent.id)")
    wrong += [] if ids == ["AGV-7", "agent-1", "agent-2", "agent-3"] and browser.value("read(scenario).agents.length") == 4 else [f"agents that are added to named ones are {ids}"]
    return wrong


def removals(browser):
    """Whoever removes an agent can go on with the others, which keep their colours; without any, one is added."""
    wrong = []
    state = lambda: browser.value("""({ ids: scenario.agents.map((agent) => agent.id), colours: scenario.agents.map((_, k) => colour(k)), which: $('which').textContent,
      chosen: $('agent').selectedOptions[0]?.text ?? '', removable: !$('remove').disabled, sliders: document.querySelectorAll('#sliders input').length, wrong: $('said').classList.contains('wrong') })""")
    click = lambda button: (browser.value(f"$('{button}').click(); 0"), browser.value(SLEEP.format(50)), state())[2]
    for steps in (("add", "remove", "remove", "remove"), ("remove", "add", "remove", "remove"), ("plan", "remove", "add", "remove", "remove")):
        browser.value("open(START); 0")
        for chosen in ("0", "scenario.agents.length - 1", "2"):
            browser.value(f"chosen = {chosen}; edit(); update(); 0")
            before = state()
            for step in steps:
                after = click(step)
                is_whole = not after["ids"] or after["removable"] and after["sliders"] and after["which"] == after["chosen"] != "" and not after["wrong"]
                if not is_whole:
                    wrong.append(f"the editor is dead after {step} of {steps}: {after}")
                colours = dict(zip(before["ids"], before["colours"]))
                if any(colours.get(id, colour) != colour for id, colour in zip(after["ids"], after["colours"])) or len(set(after["colours"])) != len(after["ids"]):
                    wrong.append(f"colours change, or are not told apart, after {step} of {steps}: {before['colours']} {after['colours']}")
                before = after
    while state()["ids"]:
        click("remove")
    alone = click("add")
    return wrong + ([] if alone["removable"] and alone["sliders"] and alone["which"] else [f"an agent that is added to none: {alone}"])


def outlines(tool, folder, browser):
    """A disc becomes a convex polygon, its corners are dragged and added, and the tool says the same of it."""
    wrong = []
    browser.value("open(START); for (const k of [0, 3, 5]) { chosen = k; edit(); $('shape').value = 'polygon'; $('shape').dispatchEvent(new Event('change')); } 0")
    wrong += same(tool, folder, browser, "with three polygons")
    before = browser.value("JSON.stringify(scenario.agents[5].footprint)")
    drag(browser, "corner", (14, -10))
    if browser.value("JSON.stringify(scenario.agents[5].footprint)") == before:
        wrong.append("a corner that is dragged stays")
    wrong += same(tool, folder, browser, "after dragging a corner")
    drag(browser, "corner", (-260, 200), moves=40)
    wrong += [] if browser.value("convex(polygon(scenario.agents[5])) && answers.valid") else ["a corner that is dragged across leaves a concave outline"]
    for count in (5, 6, 7):
        browser.value("$('corner').click(); 0")
        if browser.value("scenario.agents[5].footprint.polygon.length") != count:
            wrong.append(f"no corner {count} is added")
    browser.value("scenario.agents[5].footprint.growth = 0.1; update(); 0")
    wrong += same(tool, folder, browser, "with more corners, rounded")
    browser.screenshot(folder / "playground-outlines.png")
    concave = [{"ahead": x, "left": y} for x, y in ((0, 0), (1, 0), (0.2, 0.2), (0, 1))]
    for polygon, reason in ((concave, "only convex outlines"), (concave[:2], "3 to 16 corners")):
        agent = {key: value for key, value in ONE["agents"][0].items() if key != "radius"}
        agent["footprint"] = {"polygon": polygon}
        said = browser.value(f"(() => {{ try {{ read({json.dumps({'agents': [agent]})}); return 'taken'; }} catch (e) {{ return e.message; }} }})()")
        wrong += [] if reason in said else [f"{polygon}: {said}"]
    browser.value("$('shape').value = 'disc'; $('shape').dispatchEvent(new Event('change')); 0")
    wrong += [] if browser.value("scenario.agents[5].radius > 0 && !scenario.agents[5].footprint") else ["a polygon does not become a disc again"]
    return wrong


def links(browser, page):
    """Copies a link and opens it, in a page that is newly opened and in one that shows something else."""
    wrong = []
    browser.value("open(START); scenario.agents[0].t_start = 1.5; update(); $('share').click(); 0")
    wait(browser, lambda: browser.value("location.hash.length > 1"))
    link, here = browser.value("location.href"), browser.value("scenario")
    browser.open(page, 1400, "light")
    ready(browser)
    if browser.value("scenario") == here:
        wrong.append("the page opens with what was shared before")
    browser.value(f"location.href = {json.dumps(link)}; 0")
    wait(browser, lambda: browser.value("scenario.agents[0].t_start") == 1.5)
    for how in ("in a page that is open", "in a new one"):
        if browser.value("scenario") != here:
            wrong.append(f"the link, {how}, holds another scenario")
        browser.open(link, 1400, "light")
        ready(browser)
    browser.open(f"{page.as_uri()}#e30", 1400, "light")
    ready(browser)
    said = browser.value("$('said').textContent")
    return wrong + ([] if said.startswith("The link is not a scenario") and browser.value("scenario.agents.length") == 12 else [f"a damaged link: {said}"])


def in_firefox(program, tool, page, folder):
    """What Firefox could do otherwise: it opens, is not too wide, and what is dragged, undone and driven is what it is in Chromium."""
    folder.mkdir(exist_ok=True)
    browser, wrong = Firefox(program), []
    try:
        for width in (390, 1400):
            browser.open(page, width)
            ready(browser)
            wide = browser.value("document.documentElement.scrollWidth")
            wrong += [f"{width} px: {wide} px wide"] if wide > width else []
            browser.screenshot(folder / f"firefox-{width}.png")
        wrong += same(tool, folder, browser, "in Firefox")
        for kind, by in (("leg", (60, 35)), ("start", (-25, 40)), ("heading", (-20, -30))):
            before = browser.value("JSON.stringify(scenario)")
            drag(browser, kind, by)
            wrong += [f"dragging a {kind} changes nothing"] if browser.value("JSON.stringify(scenario)") == before else []
        wrong += same(tool, folder, browser, "in Firefox, after dragging")
        wrong += lessons(tool, folder, browser) + undoing(folder, browser) + driving(folder, browser)
        browser.open(page, 390)
        ready(browser)
        wrong += by_finger(folder, browser)
        return [f"Firefox: {line}" for line in wrong + browser.noise()]
    finally:
        browser.close()


def main(tool, page, folder):
    folder, page = Path(folder).resolve(), Path(page).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    program = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)
    if not program:
        raise SystemExit("check: no Chromium (Debian's package chromium)")
    browser, wrong = Browser(program), []
    try:
        for scheme in ("light", "dark"):
            for width in WIDTHS:
                browser.open(page, width, scheme)
                ready(browser)
                wide = browser.value("document.documentElement.scrollWidth")
                wrong += [f"{width} px: {wide} px wide"] if wide > width else []
                paper = browser.value("getComputedStyle($('plane')).backgroundColor.match(/\\d+/g).slice(0, 3).map(Number)")
                wrong += [f"{width} px, {scheme}: the plane is {paper}"] if (sum(paper) < 3 * 128) != (scheme == "dark") else []
                browser.screenshot(folder / f"playground-{width}-{scheme}.png")
                wrong += [f"{width} px, {scheme}: {said}" for said in browser.noise()]
        count, missed = reached_by_tab(browser)
        wrong += [f"Tab does not reach {control}" for control in missed]
        browser.open(page, 1400, "light")
        ready(browser)
        wrong += same(tool, folder, browser, "as it opens")
        before = browser.value("JSON.stringify(scenario)")
        drag(browser, "leg", (60, 35))
        drag(browser, "start", (-25, 40))
        drag(browser, "heading", (-20, -30))
        browser.value("(() => { const s = document.querySelector('#sliders input'); s.value = 0.31; s.dispatchEvent(new Event('input')); })()")
        browser.value(SLEEP.format(100))
        if browser.value("JSON.stringify(scenario)") == before:
            wrong.append("dragging changes nothing")
        wrong += same(tool, folder, browser, "after dragging")
        browser.screenshot(folder / "playground-dragged.png")
        # Judged by nobody: machines differ.
        browser.value("open(START); globalThis.took = []; globalThis.inner = update; update = () => { const t = performance.now(); inner(); took.push(performance.now() - t); }; 0")
        drag(browser, "leg", (90, -60), moves=40)
        took = sorted(browser.value("update = inner, took"))
        print(f"a drag with {browser.value('scenario.agents.length')} agents, regions and pictures: {len(took)} frames of {took[len(took) // 2]:.1f} ms, {took[-1]:.1f} ms at most")
        wrong += snapping(browser) + keys(browser) + files(tool, folder, browser) + refusals(tool, folder, browser) + fields(browser) + removals(browser) + outlines(tool, folder, browser) + links(browser, page)
        wrong += lessons(tool, folder, browser) + undoing(folder, browser) + driving(folder, browser)
        wrong += browser.noise()
        browser.open(page, 390, "dark")
        ready(browser)
        before = browser.value("JSON.stringify(scenario)")
        browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        drag(browser, "leg", (-40, 30), touch=True)
        browser.screenshot(folder / "playground-finger.png")
        # One that has hold of nothing scrolls, and all that is dragged can be seen.
        covered = browser.value("""(() => { const p = $('plane'), b = p.getBoundingClientRect(), { at } = frame(p.clientWidth, p.clientHeight);
          return handles(scenario.agents[chosen], at).filter((h) => document.elementFromPoint(h.x + b.left, h.y + b.top) !== p).length; })()""")
        wrong += [f"{covered} handles are covered at 390 px"] if covered else []
        empty, before_scroll = browser.value("(() => { const b = $('plane').getBoundingClientRect(); return [b.left + 4, b.bottom - 40]; })()"), browser.value("scrollY")
        finger(browser, "touchStart", *empty)
        for part in range(1, 9):
            finger(browser, "touchMove", empty[0], empty[1] - 25 * part)
            browser.value(SLEEP.format(20))
        finger(browser, "touchEnd", *empty)
        if not wait(browser, lambda: browser.value("scrollY") > before_scroll + 50):
            wrong.append("a finger that has hold of nothing does not scroll")
        if browser.value("JSON.stringify(scenario)") == before:
            wrong.append("a finger changes nothing")
        wrong += same(tool, folder, browser, "after a finger at 390 px")
        wrong += by_finger(folder, browser)
        browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
        browser.open(page, 1400, "light")
        ready(browser)
        # The paper's fleet has a plan.
        browser.value("open(START); $('plan').click(); 0")
        browser.value(SLEEP.format(200))
        if not browser.value("$('said').textContent").startswith("Planned"):
            wrong.append(f"no plan: {browser.value('$(`said`).textContent')}")
        left = [row for row in of_tool(tool, folder, browser)[1]]
        wrong += [f"the planned fleet has conflicts: {left}"] if left else []
        holds = browser.value("answers.holds && answers.holds.filter(isFinite).length")
        wrong += [] if holds else ["no agent has a hold at the start of the plan"]
        browser.screenshot(folder / "playground-planned.png")
        browser.value("open({ agents: [] }); 0")
        wrong += [] if browser.value("$('said').textContent") == "No agents." and browser.value("$('remove').disabled") else ["nobody is said to have no conflict"]
        browser.value("$('add').click(); $('add').click(); 0")
        wrong += [] if browser.value("scenario.agents.map((agent) => agent.id)") == [1, 2] else ["agents that are added have other numbers than 1 and 2"]
        for bad, reason in (('{"agents":[{"id":1}]}', "legs"), ('{"agents":[],"x":1}', "not known"), ("[]", "no agents")):
            said = browser.value(f"(() => {{ try {{ read({bad}); return 'taken'; }} catch (e) {{ return e.message; }} }})()")
            wrong += [] if reason in said else [f"{bad}: {said}"]
        wrong += browser.noise()
    finally:
        browser.close()
    other = next((path for path in map(shutil.which, ("firefox", "firefox-esr")) if path), None)
    wrong += in_firefox(other, tool, page, folder / "firefox") if other else ["there is no Firefox on this machine"]
    print(f"playground: {len(WIDTHS) * 2} windows, {count} controls: {'ok' if not wrong else ''}")
    for line in wrong:
        print(f"  {line}")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
