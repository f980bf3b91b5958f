"""Drives a headless Chromium by ChromeDriver's HTTP interface (WebDriver), with Python's library alone."""
import base64
import json
import os
import subprocess
import tempfile
import time
import urllib.request

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-dev-shm-usage", "--hide-scrollbars"]
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


class Driver:
    """ChromeDriver at a port that it chooses, and one browser window."""

    def __init__(self, width, height, phone=False):
        self.profile = tempfile.TemporaryDirectory(prefix="merlin-chromium-")
        self.log = open(os.path.join(self.profile.name, "driver.log"), "w+b")
        self.process = subprocess.Popen(["chromedriver", "--port=0"], stdout=self.log,
                                        stderr=subprocess.STDOUT)
        self.session = None
        try:
            self.url = "http://127.0.0.1:%d" % self._port()
            self._open(width, height, phone)
        except BaseException:
            self.close()
            raise

    def _port(self):
        for _ in range(300):
            self.log.seek(0)
            for line in self.log.read().decode(errors="replace").splitlines():
                if "started successfully on port " in line:
                    return int(line.split("on port ")[1].strip(" ."))
            if self.process.poll() is not None:
                break
            time.sleep(0.1)
        raise RuntimeError("chromedriver did not start")

    def _open(self, width, height, phone):
        flags = FLAGS + ["--user-data-dir=" + os.path.join(self.profile.name, "profile"),
                         "--window-size=%d,%d" % (width, height)]
        options = {"args": flags}
        if phone:
            options["mobileEmulation"] = {
                "deviceMetrics": {"width": width, "height": height, "pixelRatio": 2, "touch": True}}
        made = self.ask("POST", "/session", {"capabilities": {"alwaysMatch": {
            "browserName": "chrome", "goog:chromeOptions": options,
            "goog:loggingPrefs": {"browser": "ALL"}}}})
        self.session = "/session/" + made["sessionId"]

    def ask(self, method, path, value=None):
        body = None if value is None else json.dumps(value).encode()
        request = urllib.request.Request(self.url + path, data=body, method=method,
                                         headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            value = json.load(error)["value"]
            raise RuntimeError("%s %s: %s" % (method, path, value["message"].split("\n")[0])) from None

    def do(self, method, path, value=None):
        return self.ask(method, self.session + path, value)

    def open(self, url):
        self.do("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """Runs the body of a JavaScript function in the page; returns what it returns."""
        return self.do("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector):
        return self.do("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        """Scrolls an element to the middle of the window, where no sticky bar covers it, and clicks it."""
        self.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self.do("POST", "/element/%s/click" % self.find(selector), {})

    def type(self, selector, text):
        self.do("POST", "/element/%s/value" % self.find(selector), {"text": text})

    def press(self, key):
        """Sends a key, by its WebDriver name, to the element that has the keyboard's focus."""
        self.do("POST", "/actions", {"actions": [{"type": "key", "id": "k", "actions": [
            {"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]}]})

    def _pointer(self, selector, kind, place, steps, name="p", up=True):
        """The actions of a pointer that is pressed at `place`, relative to an element's middle, and moved in
        steps."""
        moves = [{"type": "pointerMove", "duration": 20, "origin": "pointer", "x": x, "y": y} for x, y in steps]
        return {"type": "pointer", "id": name, "parameters": {"pointerType": kind},
                "actions": [{"type": "pointerMove", "duration": 0, "origin": {ELEMENT: self.find(selector)},
                             "x": place[0], "y": place[1]},
                            {"type": "pointerDown", "button": 0}] + moves +
                           ([{"type": "pointerUp", "button": 0}] if up else [])}

    def release(self):
        """Releases the pointer that hold() pressed."""
        self.do("DELETE", "/actions")

    def _act(self, *sources):
        self.do("POST", "/actions", {"actions": list(sources)})
        self.release()

    def drag(self, selector, x, y, kind="mouse"):
        """Presses the pointer on an element, moves it by x and y pixels in steps, releases it."""
        steps = 5
        self._act(self._pointer(selector, kind, (0, 0), [(x // steps, y // steps)] * steps))

    def tap(self, selector, x, y, kind="mouse"):
        """Clicks at a place given relative to an element's middle."""
        self._act(self._pointer(selector, kind, (x, y), []))

    def hold(self, selector, kind="mouse"):
        """Presses the pointer on an element and holds it until release()."""
        self.do("POST", "/actions", {"actions": [self._pointer(selector, kind, (0, 0), [], up=False)]})

    def pinch(self, selector, near, far):
        """Moves two fingers apart, each from `near` to `far` pixels beside an element's middle."""
        steps = 5
        self._act(*(self._pointer(selector, "touch", (sign * near, 0), [(sign * (far - near) // steps, 0)] * steps, name)
                    for name, sign in (("left", -1), ("right", 1))))

    def wheel(self, selector, down):
        """Turns the wheel over an element."""
        self._act({"type": "wheel", "id": "w", "actions": [{
            "type": "scroll", "origin": {ELEMENT: self.find(selector)}, "x": 0, "y": 0, "deltaX": 0, "deltaY": down}]})

    def screenshot(self, path, whole=False):
        if whole:
            shot = self.do("POST", "/goog/cdp/execute", {"cmd": "Page.captureScreenshot", "params": {
                "captureBeyondViewport": True}})["data"]
        else:
            shot = self.do("GET", "/screenshot")
        with open(path, "wb") as file:
            file.write(base64.b64decode(shot))

    def messages(self):
        """Warnings and errors of the browser's console: faults of scripts, of the security policy, of the network."""
        return [entry["message"] for entry in self.do("POST", "/se/log", {"type": "browser"})
                if entry["level"] in ("SEVERE", "WARNING")]

    def until(self, what, condition, seconds=30):
        end = time.time() + seconds
        while not condition():
            if time.time() > end:
                raise AssertionError("not within %d s: %s; the page: %s" % (
                    seconds, what, self.run("return document.body.innerText.slice(0, 600)")))
            time.sleep(0.05)

    def close(self):
        if self.session:
            try:
                self.do("DELETE", "")
            except Exception:  # the process is killed below
                pass
        self.process.terminate()
        self.process.wait()
        self.log.close()
        for _ in range(20):  # Chromium's processes write to the profile until they end
            try:
                self.profile.cleanup()
                return
            except OSError:
                time.sleep(0.2)
