"""Does in headless Chromium what a reader does: browser.py CHROMIUM < ACTIONS, a JSON list; answers with one of results.

  ["open", PATH_OR_URL]      waits until it is loaded and drawn; milliseconds from the start of the navigation
  ["size", WIDTH, HEIGHT]    of the window, in pixels of CSS
  ["script", false]          as in a browser whose owner forbids scripts
  ["click", SELECTOR]        with the mouse, in the middle of what the selector finds, or of its first line
  ["type", TEXT]             key by key, into what has the focus
  ["choose", SELECTOR, TEXT] an option of a list, by its first letters
  ["paper", WIDTH, HEIGHT]   lays it out as for print, in a window of so many inches; ends with 0, 0
  ["eval", EXPRESSION]       its value
  ["pdf", PATH, WIDTH, HEIGHT]  prints on paper of so many inches, with margins of 15 and 14 mm; how many pages
  ["png", PATH]              a picture of the window

It speaks the DevTools protocol over a pipe (descriptors 3 and 4), so that it needs nothing but Python and Chromium.
"""
import base64
import json
import os
import re
import subprocess
import sys
import tempfile

OPTIONS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run",
           "--disable-dev-shm-usage", "--disable-background-networking", "--remote-debugging-pipe", "about:blank"]


class Browser:
    def __init__(self, program, profile):
        theirs_in, self.send = os.pipe()
        self.receive, theirs_out = os.pipe()
        # Bash puts them where Chromium looks for them.
        self.process = subprocess.Popen(
            ["bash", "-c", 'exec "${@:3}" 3<&"$1" 4>&"$2"', "bash", str(theirs_in), str(theirs_out), program,
             *OPTIONS, "--user-data-dir=" + profile],
            pass_fds=(theirs_in, theirs_out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(theirs_in)
        os.close(theirs_out)
        self.buffer, self.last, self.events, self.session, self.scripts = b"", 0, [], None, True
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Page.enable")

    def message(self):
        while b"\0" not in self.buffer:
            more = os.read(self.receive, 1 << 20)
            if not more:
                sys.exit("the browser has ended")
            self.buffer += more
        one, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(one)

    def call(self, method, **parameters):
        self.last += 1
        command = {"id": self.last, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        text = json.dumps(command).encode() + b"\0"
        while text:
            text = text[os.write(self.send, text):]
        while True:
            answer = self.message()
            if answer.get("id") == self.last:
                if "error" in answer:
                    sys.exit("%s: %s" % (method, answer["error"]["message"]))
                return answer["result"]
            self.events.append(answer.get("method"))

    def wait_for(self, event):
        while event not in self.events:
            self.events.append(self.message().get("method"))

    def eval(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            sys.exit("%s: %s" % (expression, answer["exceptionDetails"]["exception"].get("description")))
        return answer["result"].get("value")

    def open(self, where):
        self.events.clear()
        self.call("Page.navigate", url=where if ":" in where else "file://" + where)
        self.wait_for("Page.loadEventFired")
        if not self.scripts:
            return 0  # nothing of the page may run, the clock below neither
        # Twice: the first frame begins to be drawn, the second one stands behind it.
        return self.eval("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => "
                         "done(performance.now()))))")

    def size(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def script(self, allowed):
        self.scripts = allowed
        self.call("Emulation.setScriptExecutionDisabled", value=not allowed)

    def click(self, selector):
        self.eval("document.querySelector(%s).scrollIntoView({block: 'center'})" % json.dumps(selector))
        # A link that is broken into two lines is not in the middle of what holds both.
        box = self.eval("(r => [r.left + r.width / 2, r.top + r.height / 2])(document.querySelector(%s)"
                        ".getClientRects()[0])" % json.dumps(selector))
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)

    def type(self, text):
        for character in text:
            self.call("Input.dispatchKeyEvent", type="char", text=character)

    def choose(self, selector, text):
        self.eval("document.querySelector(%s).focus()" % json.dumps(selector))
        self.type(text)

    def paper(self, width, height):
        self.call("Emulation.setEmulatedMedia", media="print" if width else "")
        if width:
            self.size(round(width * 96), round(height * 96))

    def pdf(self, path, width, height):
        data = base64.b64decode(self.call("Page.printToPDF", paperWidth=width, paperHeight=height,
                                          printBackground=True, preferCSSPageSize=False,
                                          marginTop=0.59, marginBottom=0.59, marginLeft=0.55, marginRight=0.55)["data"])
        with open(path, "wb") as file:
            file.write(data)
        return len(re.findall(rb"/Type\s*/Page\b", data))

    def png(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def close(self):
        self.session = None
        self.call("Browser.close")
        self.process.wait()


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(sys.argv[1], profile)
        results = [getattr(browser, action)(*arguments) for action, *arguments in json.load(sys.stdin)]
        browser.close()
    json.dump(results, sys.stdout)


main()
