"""A Firefox and one page in it, spoken to by its own protocol Marionette: no driver is needed. What it shares with the Chromium of pages.py has the same names."""
import base64
import json
import shutil
import socket
import subprocess
import tempfile
import time
from pathlib import Path

PREFS = {"app.update.enabled": False, "browser.shell.checkDefaultBrowser": False, "datareporting.policy.dataSubmissionEnabled": False, "dom.w3c_touch_events.enabled": 1,
         "network.captive-portal-service.enabled": False, "network.connectivity-service.enabled": False, "toolkit.telemetry.reportingpolicy.firstRun": False, "browser.aboutwelcome.enabled": False}
KEYS = {"ArrowUp": "\uE013", "ArrowDown": "\uE015", "ArrowLeft": "\uE012", "ArrowRight": "\uE014", "Enter": "\uE007", "Tab": "\uE004"}
# As in the protocol of Chromium: 2 is Ctrl, 8 is Shift.
MODIFIERS = {2: "\uE009", 8: "\uE008"}
# Names of the page's own scripts are no properties of its window.
ASK = """const [text, done] = arguments;
window.eval("(async (text) => { try { return JSON.stringify([(await (0, eval)(text)) ?? null]); } catch (e) { return 'throws ' + e; } })")(text).then(done);"""
ERRORS = "return Services.console.getMessageArray().filter((m) => m instanceof Ci.nsIScriptError && m.sourceName.startsWith('file:')).map((m) => m.toString());"


class Firefox:
    def __init__(self, program):
        self.profile = tempfile.mkdtemp(prefix="pcr-firefox-")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        prefs = {**PREFS, "marionette.port": port}
        Path(self.profile, "user.js").write_text("".join(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in prefs.items()))
        self.process = subprocess.Popen([program, "--headless", "--marionette", "--remote-allow-system-access", "--no-remote", "--profile", self.profile], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(600):
            try:
                self.socket = socket.create_connection(("127.0.0.1", port))
                break
            except OSError:
                time.sleep(0.1)
        else:
            raise SystemExit("firefox: it does not come up")
        self.buffer, self.last = b"", 0
        self.message()
        self.call("WebDriver:NewSession", capabilities={"alwaysMatch": {}})

    def message(self):
        while b":" not in self.buffer or len(self.buffer) < self.end():
            part = self.socket.recv(1 << 16)
            if not part:
                raise SystemExit("firefox: it ended")
            self.buffer += part
        end = self.end()
        text, self.buffer = self.buffer[:end].split(b":", 1)[1], self.buffer[end:]
        return json.loads(text)

    def end(self):
        size, _, _ = self.buffer.partition(b":")
        return len(size) + 1 + int(size)

    def call(self, method, **params):
        self.last += 1
        text = json.dumps([0, self.last, method, params]).encode()
        self.socket.sendall(str(len(text)).encode() + b":" + text)
        _, number, error, result = self.message()
        if number != self.last or error:
            raise SystemExit(f"firefox: {method}: {error}")
        return result

    def open(self, page, width, height=900):
        self.call("WebDriver:Navigate", url="about:blank")
        # Windows have a least width; what is in them has not.
        self.chrome(f"const b = gBrowser.selectedBrowser; b.style.minWidth = b.style.maxWidth = '{width}px'; b.style.minHeight = b.style.maxHeight = '{height}px';")
        self.call("WebDriver:Navigate", url=page.as_uri())

    def chrome(self, script):
        self.call("Marionette:SetContext", value="chrome")
        answer = self.call("WebDriver:ExecuteScript", script=script, args=[])["value"]
        self.call("Marionette:SetContext", value="content")
        return answer

    def value(self, expression):
        answer = self.call("WebDriver:ExecuteAsyncScript", script=ASK, args=[expression])["value"]
        if answer.startswith("throws "):
            raise SystemExit(f"firefox: {expression}: {answer}")
        return json.loads(answer)[0]

    def key(self, key, modifiers=0):
        held = [sign for bit, sign in MODIFIERS.items() if modifiers & bit]
        sign = KEYS.get(key, key)
        does = lambda kind, value: {"type": kind, "value": value}
        actions = [*(does("keyDown", one) for one in held), does("keyDown", sign), does("keyUp", sign), *(does("keyUp", one) for one in held)]
        self.call("WebDriver:PerformActions", actions=[{"type": "key", "id": "keys", "actions": actions}])

    def pull(self, point, by, touch, moves):
        to = lambda part: {"type": "pointerMove", "duration": 0, "x": round(point[0] + by[0] * part), "y": round(point[1] + by[1] * part)}
        actions = [to(0), {"type": "pointerDown", "button": 0}]
        for move in range(1, moves + 1):
            actions += [to(move / moves), {"type": "pause", "duration": 50}]
        actions.append({"type": "pointerUp", "button": 0})
        kind = "touch" if touch else "mouse"
        self.call("WebDriver:PerformActions", actions=[{"type": "pointer", "id": kind, "parameters": {"pointerType": kind}, "actions": actions}])

    def choose(self, file):
        [element] = self.call("WebDriver:FindElement", using="css selector", value="#load")["value"].values()
        self.call("WebDriver:ElementSendKeys", id=element, text=str(file))

    def screenshot(self, path):
        path.write_bytes(base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"]))

    def noise(self):
        return self.chrome(ERRORS)

    def close(self):
        self.process.terminate()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)
