#!/usr/bin/env python3
"""check.py PCR PAGE FOLDER: opens the playground in headless Chromium, and fails unless

- nothing is written to the console, nothing asked of the network, nothing wider than windows of 390, 900 and 1400 px;
- the Tab key reaches every control;
- a drag of a leg, of a start, by a finger, too, and a slider change the scenario, and all regions and conflicts are then those of the tool PCR, bit for bit;
- delays that the page plans leave no conflict for the tool;
- a saved scenario comes back by its link, and what is no scenario is refused with a reason.

Screenshots stay in FOLDER."""
import json
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(path.parent) for path in TOP.glob("pcr-host/tests/browser/pages.py")]
from pages import SLEEP, WIDTHS, Browser, reached_by_tab  # noqa: E402

ROWS = "(() => {{ rows(pcr.pcr_build(scenario.agents.length), 0); return rows({}); }})()"


def mouse(browser, kind, x, y):
    browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)


def finger(browser, kind, x, y):
    browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[] if kind == "touchEnd" else [{"x": x, "y": y}])


def drag(browser, kind, by, touch=False):
    act = finger if touch else mouse
    begin, on, end = ("touchStart", "touchMove", "touchEnd") if touch else ("mousePressed", "mouseMoved", "mouseReleased")
    handle = browser.value(f"""(() => {{ const p = $('plane'), b = p.getBoundingClientRect();
      const h = handles(scenario.agents[chosen], frame(p.clientWidth, p.clientHeight).at).find((h) => h.kind === '{kind}');
      return [h.x + b.left, h.y + b.top]; }})()""")
    act(browser, begin, *handle)
    for part in (0.5, 1):
        act(browser, on, handle[0] + by[0] * part, handle[1] + by[1] * part)
        browser.value(SLEEP.format(50))
    act(browser, end, handle[0] + by[0], handle[1] + by[1])
    browser.value(SLEEP.format(100))


def of_tool(tool, folder, browser):
    """What the tool says of the scenario of the page, in the order and shape of the page's rows."""
    scenario = browser.value("JSON.stringify(scenario)")
    file = folder / "scenario.json"
    file.write_text(scenario)
    ids = {agent["id"]: k for k, agent in enumerate(json.loads(scenario)["agents"])}
    run = lambda *arguments: json.loads(subprocess.run([tool, *arguments, file, "--json", "-q"], capture_output=True, text=True, check=False).stdout)
    regions = [[ids[r["i"]], ids[r["j"]], *r["t"], *r["l"]] for r in run("regions")["regions"]]
    conflicts = [[ids[c["i"]], ids[c["j"]], *c["t"], c["depth"]] for c in run("check")["conflicts"]]
    return sorted(regions), sorted(conflicts)


def same(tool, folder, browser, when):
    page = (sorted(row[:6] for row in browser.value(ROWS.format("pcr.pcr_regions(), 8"))),
            sorted(row[:5] for row in browser.value(ROWS.format("pcr.pcr_conflicts(), 10"))))
    tools = of_tool(tool, folder, browser)
    if page == tools:
        print(f"{when}: {len(page[0])} regions and {len(page[1])} conflicts, the same bits")
        return []
    return [f"{when}: the page and the tool differ: {[len(part) for part in page]} and {[len(part) for part in tools]} rows; "
            f"{next((pair for part in (0, 1) for pair in zip(page[part], tools[part]) if pair[0] != pair[1]), None)}"]


def main(tool, page, folder):
    folder, page = Path(folder).resolve(), Path(page).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    program = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)
    if not program:
        raise SystemExit("check: no Chromium (Debian's package chromium)")
    browser, wrong = Browser(program), []
    ready = lambda: [browser.value(SLEEP.format(100)) for _ in range(50) if browser.value("document.body.dataset.ready") != "yes"]
    try:
        for scheme in ("light", "dark"):
            for width in WIDTHS:
                browser.open(page, width, scheme)
                ready()
                wide = browser.value("document.documentElement.scrollWidth")
                wrong += [f"{width} px: {wide} px wide"] if wide > width else []
                browser.screenshot(folder / f"playground-{width}-{scheme}.png")
                wrong += [f"{width} px, {scheme}: {said}" for said in browser.noise()]
        count, missed = reached_by_tab(browser)
        wrong += [f"Tab does not reach {control}" for control in missed]
        browser.open(page, 1400, "light")
        ready()
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
        before = browser.value("JSON.stringify(scenario)")
        browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        drag(browser, "leg", (-40, 30), touch=True)
        browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
        if browser.value("JSON.stringify(scenario)") == before:
            wrong.append("a finger changes nothing")
        wrong += same(tool, folder, browser, "after a finger")
        # Judged by nobody: machines differ.
        frame = browser.value("(() => { const before = performance.now(); for (let k = 0; k < 50; k++) update(); return (performance.now() - before) / 50; })()")
        print(f"a frame of {browser.value('scenario.agents.length')} agents, regions and pictures: {frame:.1f} ms")
        link = browser.value("toLink(scenario)")
        again = browser.value(f"JSON.stringify(read(fromLink('{link}'))) === JSON.stringify(scenario)")
        wrong += [] if again else ["the link holds another scenario"]
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
        for bad, reason in (('{"agents":[{"id":1}]}', "legs"), ('{"agents":[],"x":1}', "not known"), ("[]", "no agents")):
            said = browser.value(f"(() => {{ try {{ read({bad}); return 'taken'; }} catch (e) {{ return e.message; }} }})()")
            wrong += [] if reason in said else [f"{bad}: {said}"]
        wrong += browser.noise()
    finally:
        browser.close()
    print(f"playground: {len(WIDTHS) * 2} windows, {count} controls: {'ok' if not wrong else ''}")
    for line in wrong:
        print(f"  {line}")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
