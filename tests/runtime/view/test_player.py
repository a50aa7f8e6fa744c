"""The player in a real browser, where there is one, in real time."""

import base64
import fcntl
import io
import json
import os
import select
import shutil
import signal
import subprocess
import time

import numpy as np
import pytest
from PIL import Image

from mlmg_runtime.view.html import page_of
from mlmg_runtime.view.scene import scene_from_bvh

_FLAGS = (
    "--headless",
    "--no-sandbox",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    "--enable-unsafe-swiftshader",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--window-size=480,360",
    "--remote-debugging-pipe",
)
_PATIENCE_S = 30.0


class Browser:
    """A Chromium that is spoken to through the pipes 3 and 4: JSON messages that end in a zero byte."""

    def __init__(self, program, profile):
        (child_reads, self.write), (self.read, child_writes) = os.pipe(), os.pipe()
        theirs = [fcntl.fcntl(end, fcntl.F_DUPFD, 20) for end in (child_reads, child_writes)]
        self.process = subprocess.Popen(
            [program, *_FLAGS, f"--user-data-dir={profile}"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            pass_fds=(3, 4),
            preexec_fn=lambda: (os.dup2(theirs[0], 3), os.dup2(theirs[1], 4)),  # noqa: PLW1509 - no threads here
        )
        for end in (child_reads, child_writes, *theirs):
            os.close(end)
        self.unread = b""
        self.passed = []
        self.n_sent = 0
        self.session = None

    def close(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        os.close(self.write)
        os.close(self.read)

    def ask(self, method, **parameters):
        """Return the answer to one message."""
        self.n_sent += 1
        message = {"id": self.n_sent, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write, json.dumps(message).encode() + b"\0")
        answer = self.wait(lambda message: message.get("id") == self.n_sent)
        assert "error" not in answer, answer
        return answer["result"]

    def wait(self, wanted):
        """Return the first message that is wanted, also of those that have been passed over."""
        end = time.monotonic() + _PATIENCE_S
        while not (found := [message for message in self.passed if wanted(message)]):
            self.passed.append(self._next(end))
        return found[0]

    def _next(self, end):
        while b"\0" not in self.unread:
            if not select.select([self.read], [], [], max(end - time.monotonic(), 0.0))[0]:
                raise TimeoutError
            got = os.read(self.read, 1 << 16)
            if not got:
                raise TimeoutError
            self.unread += got
        message, _, self.unread = self.unread.partition(b"\0")
        return json.loads(message)

    def open(self, address):
        self.session = None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.ask("Page.enable")
        self.ask("Page.navigate", url=address)
        loaded = {"method": "Page.loadEventFired", "sessionId": self.session}
        self.wait(lambda message: loaded.items() <= message.items())

    def value(self, expression):
        """Return the value of an expression in the page, when its promise is kept."""
        result = self.ask("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def until(self, condition):
        """Wait until an expression is true in the page."""
        self.value(f"new Promise((kept) => (function ask() {{ {condition} ? kept() : setTimeout(ask, 20); }})())")

    def press(self, key, text=""):
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=key, text=text if kind == "keyDown" else "")


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    program = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if program is None:
        pytest.skip("no Chromium is installed")
    browser = Browser(program, tmp_path_factory.mktemp("profile"))
    try:
        browser.ask("Browser.getVersion")
        yield browser
    except TimeoutError:
        pytest.skip("Chromium does not start here")
    finally:
        browser.close()


@pytest.fixture
def player(browser, scene, person, tmp_path):
    """Return the browser with a player of two motions open, still, at frame 12."""
    page = tmp_path / "player.html"
    page.write_text(page_of([scene, scene_from_bvh(person(n_frames=30), "short")]), encoding="utf-8")
    browser.open(f"{page.as_uri()}#frame=12")
    browser.until("document.documentElement.dataset.state !== 'loading'")
    if browser.value("document.documentElement.dataset.state") == "no-webgl":
        pytest.skip("Chromium has no WebGL 2 here")
    return browser


def at_frame(browser, frame):
    browser.until(f"document.documentElement.dataset.frame === '{frame}'")


def panes(browser):
    """Return what the two halves of the stage look like, without the text, from 0 to 255."""
    browser.value("document.getElementById('labels').hidden = true; 0")
    box = json.loads(browser.value("JSON.stringify(document.getElementById('canvas').getBoundingClientRect())"))
    shot = base64.b64decode(browser.ask("Page.captureScreenshot")["data"])
    with Image.open(io.BytesIO(shot)) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)[: int(box["height"]), : int(box["width"])]
    middle = pixels.shape[1] // 2
    return pixels[:, :middle], pixels[:, middle:]


def text(browser, selector):
    return browser.value(f"[...document.querySelectorAll('{selector}')].map((one) => one.textContent).join('|')")


def test_the_player_opens_still_at_the_frame_of_its_address(player):
    assert player.value("document.documentElement.dataset.state") == "ready"
    at_frame(player, 12)
    assert text(player, ".pane .name") == "stroll|short"
    assert text(player, ".pane .command") == "WALK for 1 sec|"
    assert text(player, ".pane .graphs") == "Full-BodyIdle_01 → Walk_01|"
    assert player.value("performance.getEntriesByType('resource').length") == 0


def test_each_pane_shows_a_bright_figure_on_a_dark_floor(player):
    left, right = panes(player)
    for pane in (left, right):
        bright = pane.min(axis=-1) > 120
        _, columns = np.nonzero(bright)
        assert 0.01 < bright.mean() < 0.3
        assert abs(np.median(columns) / pane.shape[1] - 0.5) < 0.15
    player.press("]", "]")
    player.press("ArrowRight")
    at_frame(player, 31)
    player.value("location.hash = 'frame=45'; 0")
    at_frame(player, 45)
    orange = [(pane[..., 0] > pane[..., 2] + 60).mean() for pane in panes(player)]
    assert orange[0] > 0.002
    assert orange[1] == 0.0


def test_keys_step_jump_and_play(player):
    for key, text_of_key, frame in (
        ("ArrowRight", "", 13),
        ("ArrowLeft", "", 12),
        ("]", "]", 30),
        ("End", "", 59),
        ("[", "[", 30),
        ("Home", "", 0),
    ):
        player.press(key, text_of_key)
        at_frame(player, frame)
    player.press(" ", " ")
    player.until("Number(document.documentElement.dataset.frame) > 2")
    player.press(" ", " ")
    assert not player.value("document.body.classList.contains('playing')")
    for key in "bpfvvlr":
        player.press(key, key)
    player.press("ArrowRight")
    assert player.value("document.documentElement.dataset.state") == "ready"


def test_a_drag_turns_the_view_and_pressing_the_timeline_goes_there(player):
    shots = []
    for x, y in ((100, 100), (160, 100)):
        shots.append(player.ask("Page.captureScreenshot")["data"])
        kind = "mousePressed" if not shots[1:] else "mouseMoved"
        player.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
    player.ask("Input.dispatchMouseEvent", type="mouseReleased", x=160, y=100, button="left")
    player.value("new Promise((kept) => requestAnimationFrame(() => requestAnimationFrame(kept)))")
    assert player.ask("Page.captureScreenshot")["data"] != shots[0]
    lane = player.value("JSON.stringify(document.querySelector('.lane > div').getBoundingClientRect())")
    box = json.loads(lane)
    for kind in ("mousePressed", "mouseReleased"):
        x, y = box["left"] + 0.999 * box["width"], box["top"] + 5
        player.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
    player.until("Number(document.documentElement.dataset.frame) >= 58")
