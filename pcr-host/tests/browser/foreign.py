#!/usr/bin/env python3
"""foreign.py PCR FOLDER: opens pages of somebody else in headless Chromium, while `pcr serve` runs, and fails unless

- nothing that they send to the lines over TCP or to the live page is carried out: forms, fetch, XMLHttpRequest, beacons, WebSockets, event
  streams, images, scripts, frames and styles, with lines of JSON as their bodies, from other origins and under other names;
- they can read nothing of the live page;
- the log says that a browser has tried, and which page;
- clients with the token are served before, meanwhile and after that, and a client without it is not.

The pages are of another port of this machine, and of a name that leads there."""

import functools
import http.server
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

from pages import Browser, program

ABILITIES = {"radius": 0.25, "speed": 1, "acceleration": 0.5}
# East stands in the crossing that north waits for: without it, north may go on.
FLEET = [
    {"verb": "add", "robot": "east", "start": {"x": 0, "y": 0, "heading": 0}, "abilities": ABILITIES},
    {"verb": "add", "robot": "north", "start": {"x": 0, "y": -4, "heading": 1.5707963267948966}, "abilities": ABILITIES},
    {"verb": "mission", "robot": "north", "mission": "1", "path": [{"kind": "line", "length": 8}]},
]
EVIL = [
    {"verb": "remove", "robot": "east"},
    {"verb": "position", "robot": "north", "path": 1, "at": [0, 0]},
    {"verb": "add", "robot": "evil", "start": {"x": 50, "y": 50, "heading": 0}, "abilities": ABILITIES},
]
# A name that leads to this machine, as somebody else can have one of his do.
NAME = "evil.example"
HELLO = {"pcr": 1, "verb": "hello"}
# How a page sends text to an address; each is a body of a function that may wait.
WAYS = {
    "fetch, no-cors": "await fetch(url, { method: 'POST', mode: 'no-cors', body: text })",
    "fetch, no-cors, blob": "await fetch(url, { method: 'POST', mode: 'no-cors', body: new Blob([text]) })",
    "fetch, no-cors, keepalive": "await fetch(url, { method: 'POST', mode: 'no-cors', keepalive: true, body: text })",
    "fetch, cors": "await fetch(url, { method: 'POST', body: text, headers: { 'Content-Type': 'text/plain' } })",
    "fetch, JSON": "await fetch(url, { method: 'POST', body: text, headers: { 'Content-Type': 'application/json' } })",
    "fetch, PUT": "await fetch(url, { method: 'PUT', body: text })",
    "fetch, DELETE": "await fetch(url, { method: 'DELETE', body: text })",
    "fetch, GET, no-cors": "await fetch(url + '?' + encodeURIComponent(text), { mode: 'no-cors' })",
    "fetch, GET with credentials": "await fetch(url, { credentials: 'include' })",
    "XMLHttpRequest": "await new Promise((done) => { const x = new XMLHttpRequest(); x.open('POST', url); x.onloadend = done; x.send(text); })",
    "beacon": "navigator.sendBeacon(url, text)",
    "beacon, blob": "navigator.sendBeacon(url, new Blob([text], { type: 'text/plain' }))",
    "WebSocket": "await new Promise((done) => { const w = new WebSocket(url.replace('http', 'ws')); w.onopen = () => w.send(text); w.onclose = w.onerror = done; })",
    "event stream": "await new Promise((done) => { const s = new EventSource(url); s.onmessage = s.onerror = () => { s.close(); done(); }; })",
    "image": "await new Promise((done) => { const i = new Image(); i.onload = i.onerror = done; i.src = url + '?' + encodeURIComponent(text); })",
    "script": "await new Promise((done) => { const s = document.createElement('script'); s.onload = s.onerror = done; s.src = url; document.body.append(s); })",
    "style": "await new Promise((done) => { const s = document.createElement('link'); s.rel = 'stylesheet'; s.onload = s.onerror = done; s.href = url; document.body.append(s); })",
    "frame": "await new Promise((done) => { const f = document.createElement('iframe'); f.onload = done; f.src = url; document.body.append(f); setTimeout(done, 1000); })",
    # As in the page that was shown to command robots.
    "form, text": "await form('text/plain')",
    "form, URL": "await form('application/x-www-form-urlencoded')",
    "form, multipart": "await form('multipart/form-data')",
}
FORM = """const form = (kind) => new Promise((done) => {
  const frame = document.createElement('iframe'); frame.name = 'f' + Math.random(); frame.onload = () => setTimeout(done, 100);
  const form = Object.assign(document.createElement('form'), { method: 'post', enctype: kind, action: url, target: frame.name });
  const area = document.createElement('textarea');
  [area.name, area.value] = [text.slice(0, text.indexOf(':') + 1), text.slice(text.indexOf(':') + 1)];
  form.append(area); document.body.append(frame, form); form.submit(); setTimeout(done, 2000);
});"""


class Supervisor:
    def __init__(self, tool, folder):
        self.process = subprocess.Popen([tool, "serve", "--stay", "--journal", folder / "state", "--listen", "0", "--page", "0"],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.log = []
        for _ in range(2):
            while not self.log or "listening" not in self.log[-1]:
                self.log.append(self.process.stderr.readline())
                if not self.log[-1]:
                    raise SystemExit(f"foreign: pcr serve has ended: {''.join(self.log)}")
            self.log.append("")
        said = "".join(self.log)
        self.lines, self.page = (int(port) for port in re.findall(r'address="127\.0\.0\.1:(\d+)"', said)[:2])
        self.token = Path(re.search(r' token="([^"]+)"', said)[1]).read_text().strip()
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stderr:
            self.log.append(line)

    def ask(self, requests, token=None):
        """The answers of a connection, until it ends."""
        with socket.create_connection(("127.0.0.1", self.lines)) as client:
            hello = HELLO | ({"token": token} if token else {})
            text = "".join(json.dumps(line) + "\n" for line in [hello, *requests])
            client.sendall(text.encode())
            client.shutdown(socket.SHUT_WR)
            return [json.loads(line) for line in client.makefile()]

    def state(self):
        """All that a client could have changed."""
        robots, counts = (answer["ok"] for answer in self.ask([{"verb": "query", "what": what} for what in ("robots", "counts")], self.token)[1:])
        # By itself it notes who is silent, and tries the missions again that wait.
        robots = [{name: value for name, value in robot.items() if name != "silent"} for robot in robots["robots"]]
        return robots, {name: counts[name] for name in ("positions", "missions", "admitted")}


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def evil():
    """Bodies whose lines would be carried out, also where something stands in front of them and behind."""
    lines = "\n".join(json.dumps(line) for line in EVIL)
    return [f"\n{lines}\n", f"{json.dumps(HELLO)}\n{lines}\n"]


def check(browser, supervisor, host):
    wrong = []
    before = supervisor.state()
    browser.open(f"http://{host}/evil.html", 900, "light")
    for target, paths in ((supervisor.lines, ["/"]), (supervisor.page, ["/", "/state", "/map?robot=east", "/remove"])):
        for path in paths:
            for way, code in WAYS.items():
                for text in evil():
                    # Of its own name, it may read what comes, if anything does.
                    url = f"http://{NAME if host.startswith(NAME) and target == supervisor.lines else '127.0.0.1'}:{target}{path}"
                    read = browser.value(f"(async () => {{ const url = {json.dumps(url)}, text = {json.dumps(text)}; {FORM} "
                                         f"try {{ const answer = {code}; return answer?.text ? await answer.text() : ''; }} catch (error) {{ return ''; }} }})()")
                    if read:
                        wrong.append(f"{host}: {way} to {path} of {target} could read {read[:60]!r}")
            if supervisor.state() != before:
                wrong.append(f"{host}: {path} of {target}: the state is another one")
                before = supervisor.state()
    # Whole pages that send a form by themselves, as they are shown.
    for text in evil():
        for kind in ("text/plain", "application/x-www-form-urlencoded"):
            browser.open(f"http://{host}/evil.html", 900, "light")
            browser.value(f"(() => {{ const url = 'http://127.0.0.1:{supervisor.lines}/', text = {json.dumps(text)}; "
                          f"const form = Object.assign(document.createElement('form'), {{ method: 'post', enctype: '{kind}', action: url }}); "
                          "const area = document.createElement('textarea'); [area.name, area.value] = [text, '']; form.append(area); "
                          "document.body.append(form); form.submit(); })()")
            # The page that is shown may be another one by now, in which nothing can be asked.
            time.sleep(0.3)
    if supervisor.state() != before:
        wrong.append(f"{host}: a form: the state is another one")
    # Under a name that leads here, the live page shows nothing.
    for path in ("", "state", "metrics"):
        browser.open(f"http://{NAME}:{supervisor.page}/{path}", 900, "light")
        shown = browser.value("document.body.innerText").strip()
        if shown != "not under this name":
            wrong.append(f"under another name /{path} shows {shown[:60]!r}")
    return wrong


def main(tool, folder):
    folder = Path(folder).resolve() / "foreign"
    folder.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(folder / "state", ignore_errors=True)
    (folder / "evil.html").write_text("<!doctype html><title>somebody else</title><body></body>")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    supervisor = Supervisor(tool, folder)
    wrong = []
    browser = None
    try:
        told = supervisor.ask(FLEET, supervisor.token)
        if not all("ok" in answer for answer in told):
            raise SystemExit(f"foreign: {told}")
        browser = Browser(program(), f"--host-resolver-rules=MAP {NAME} 127.0.0.1")
        for host in (f"127.0.0.1:{server.server_port}", f"localhost:{server.server_port}", f"{NAME}:{server.server_port}"):
            wrong += check(browser, supervisor, host)
        log = "".join(supervisor.log)
        for said in ("a browser or an HTTP client has sent a request to the lines", f'page="http://127.0.0.1:{server.server_port}"'):
            if said not in log:
                wrong.append(f"the log does not say {said}")
        # Few lines, however often somebody tries.
        if len(supervisor.log) > 100:
            wrong.append(f"the log has {len(supervisor.log)} lines")
        if "ok" in supervisor.ask(EVIL)[0]:
            wrong.append("a client without the token is let in")
        # It goes on: without the robot in the crossing, the other one is admitted.
        last = supervisor.ask([EVIL[0], {"verb": "query", "what": "robots"}], supervisor.token)
        if last[1].get("ok") != {"removed": True} or [robot["robot"] for robot in last[2]["ok"]["robots"]] != ["north"]:
            wrong.append(f"it does not go on: {last}")
    finally:
        if browser:
            browser.close()
        supervisor.process.terminate()
        status = supervisor.process.wait(timeout=10)
        server.shutdown()
    wrong += [f"pcr serve ended with {status}"] if status else []
    for line in wrong:
        print(f"  {line}")
    print(f"foreign: {len(WAYS)} ways of pages of others: {'ok' if not wrong else ''}")
    if wrong:
        raise SystemExit(1)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main(os.path.abspath(sys.argv[1]), sys.argv[2])
