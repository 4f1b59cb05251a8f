"""What the checks of the playground share: hands that drag, and what the tool says of the scenario that is shown."""
import json
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(path.parent) for path in TOP.glob("pcr-host/tests/browser/pages.py")]
from firefox import Firefox  # noqa: E402
from pages import SLEEP  # noqa: E402

ROWS = "(() => {{ rows(pcr.pcr_build(scenario.agents.length), 0); return rows({}); }})()"


def mouse(browser, kind, x, y):
    browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)


def finger(browser, kind, x, y):
    browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[] if kind == "touchEnd" else [{"x": x, "y": y}])


def pull(browser, point, by, touch=False, moves=2):
    """Drags from a point of the window, all in pixels."""
    if isinstance(browser, Firefox):
        browser.pull(point, by, touch, moves)
        browser.value(SLEEP.format(100))
        return
    act = finger if touch else mouse
    begin, on, end = ("touchStart", "touchMove", "touchEnd") if touch else ("mousePressed", "mouseMoved", "mouseReleased")
    act(browser, begin, *point)
    for move in range(1, moves + 1):
        act(browser, on, point[0] + by[0] * move / moves, point[1] + by[1] * move / moves)
        browser.value(SLEEP.format(50))
    act(browser, end, point[0] + by[0], point[1] + by[1])
    browser.value(SLEEP.format(100))


def drag(browser, kind, by, touch=False, moves=2, last=False):
    """Drags the first handle of a kind, or the last one."""
    point = browser.value(f"""(() => {{ const p = $('plane'); p.scrollIntoView({{ block: 'center' }}); const b = p.getBoundingClientRect();
      const h = handles(scenario.agents[chosen], frame(p.clientWidth, p.clientHeight).at).filter((h) => h.kind === '{kind}').at({-1 if last else 0});
      return [h.x + b.left, h.y + b.top]; }})()""")
    pull(browser, point, by, touch, moves)


def drag_line(browser, seconds, touch=False):
    """Drags the middle of the line in the collision map to a later start."""
    point = browser.value("""(() => { const m = $('map'); m.scrollIntoView({ block: 'center' }); const b = m.getBoundingClientRect(), a = axes(b.width, b.height);
      const length = answers.lengths[chosen] / 2, [t, l] = track().find(([, l]) => l >= length);
      return [b.left + a.px(t), b.top + a.py(l), a.px(1) - a.px(0)]; })()""")
    pull(browser, point[:2], (seconds * point[2], 0), touch)


def choose(browser, file):
    """Chooses a file in the page's field for files."""
    if isinstance(browser, Firefox):
        browser.choose(file)
        return
    field = browser.call("Runtime.evaluate", expression="$('load')")["result"]["objectId"]
    browser.call("DOM.setFileInputFiles", files=[str(file)], objectId=field)


def wait(browser, done):
    for _ in range(100):
        if done():
            return True
        browser.value(SLEEP.format(50))
    return False


def ready(browser):
    if not wait(browser, lambda: browser.value("document.body.dataset.ready") == "yes"):
        raise SystemExit("check: the page does not come up")


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
    page = (sorted(row[:6] for row in browser.value(ROWS.format("pcr.pcr_regions(), 10"))),
            sorted(row[:5] for row in browser.value(ROWS.format("pcr.pcr_conflicts(), 10"))))
    tools = of_tool(tool, folder, browser)
    if page == tools:
        print(f"{when}: {len(page[0])} regions and {len(page[1])} conflicts, the same bits")
        return []
    return [f"{when}: the page and the tool differ: {[len(part) for part in page]} and {[len(part) for part in tools]} rows; "
            f"{next((pair for part in (0, 1) for pair in zip(page[part], tools[part]) if pair[0] != pair[1]), None)}"]
