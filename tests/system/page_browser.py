"""A person at the operator's page, in a headless Chromium:
python3 page_browser.py URL TOKEN STATUS FOLDER SIZE MODE_BUTTON WALL_PID

URL, TOKEN: the address of the page, and its token; STATUS: a command that prints `merlin status --json` of the
same daemon; FOLDER: gets the screenshots; SIZE: desktop or phone; MODE_BUTTON: "X Y", a pixel of the frame on the
button of the operator's panel that switches the mode; WALL_PID: the daemon's process, which is ended at last.
If a check fails, the program ends with a sentence that says which one.
"""
import json
import os
import signal
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import browser  # noqa: E402

URL, TOKEN, STATUS, FOLDER, SIZE, MODE_BUTTON, WALL_PID = sys.argv[1:]
PHONE = SIZE == "phone"
POINTER = "touch" if PHONE else "mouse"
# Messages of the console that are no fault: requests that the server had to refuse.
EXPECTED = ("401 (Unauthorized)",)


def status():
    return json.loads(subprocess.run(STATUS.split(), capture_output=True, text=True, check=True).stdout)


def content():
    shown = status()["content"]
    return shown["index"] if isinstance(shown, dict) else shown


def pixels(driver):
    """Mean brightness of columns of the picture that the browser shows."""
    return driver.run("""
        const image = document.getElementById('picture'), canvas = document.createElement('canvas');
        if (!image.naturalWidth) return null;
        canvas.width = 64; canvas.height = 16;
        const context = canvas.getContext('2d');
        context.drawImage(image, 0, 0, 64, 16);
        return Array.from(context.getImageData(0, 0, 64, 16).data.filter((v, i) => i % 4 === 1));""")


def difference(a, b):
    return sum(abs(x - y) for x, y in zip(a, b)) / max(1, len(a))


def unlock(driver):
    driver.open(URL)
    driver.until("the state is shown", lambda: driver.run(
        "return document.getElementById('head-rate').textContent !== '–'"))
    assert driver.run("return document.getElementById('rate').disabled"), "unlocked without a token"
    driver.click("#lock")
    driver.type("#token", "A" * 32)
    driver.click("#token-send")
    driver.until("a wrong token is refused", lambda: driver.run(
        "return document.getElementById('token-fault').textContent === 'The token is wrong.'"))
    assert driver.run("return sessionStorage.length") == 0, "a wrong token is kept"
    driver.type("#token", TOKEN)
    driver.click("#token-send")
    driver.until("the page is unlocked", lambda: driver.run(
        "return document.getElementById('lock').textContent === 'Unlocked'"))


def looks(driver):
    driver.until("the picture is shown", lambda: pixels(driver) is not None)
    picture = pixels(driver)
    assert max(picture) - min(picture) > 20, "the picture is of one colour"
    driver.until("frames are drawn", lambda: driver.run("""
        const canvas = document.getElementById('frames'), data = canvas.getContext('2d')
            .getImageData(0, 0, canvas.width, canvas.height).data;
        return data.filter((v, i) => i % 4 === 3 && v > 0).length > 200"""))
    driver.until("devices are listed", lambda: driver.run(
        "return document.querySelectorAll('#devices .item .dot.ok').length === 3"))
    wide = driver.run("return [document.documentElement.scrollWidth, innerWidth]")
    assert wide[0] <= wide[1], "the page is %d pixels wide in a window of %d" % tuple(wide)


def commands(driver):
    mode = status()["mode"]
    driver.click("#command-next_mode")
    driver.until("a click switches the mode", lambda: status()["mode"] != mode)
    driver.click("#command-next_mode")
    driver.until("and back", lambda: status()["mode"] == mode)
    driver.run("""const slider = document.getElementById('rate');
        slider.value = 14; slider.dispatchEvent(new Event('input'));
        slider.dispatchEvent(new Event('change'));""")
    driver.until("the slider sets the rate", lambda: status()["rate_asked"] == 14)
    driver.click("#rate-auto")
    driver.until("auto returns to the configured rate", lambda: status()["rate_asked"] == 10)
    driver.run("""const slider = document.getElementById('triangles');
        slider.value = 700; slider.dispatchEvent(new Event('input'));
        slider.dispatchEvent(new Event('change'));""")
    driver.until("the slider holds the triangles", lambda: status()["detail"]["held_cost"] > 0)
    driver.click("#triangles-auto")
    driver.until("auto releases them", lambda: status()["detail"]["held_cost"] == 0)
    driver.click("#command-next_content")
    driver.until("the next content is shown", lambda: content() == 1)
    name = status()["content"]["name"] if isinstance(status()["content"], dict) else "content 2"
    driver.until("and the page says so", lambda: driver.run(
        "return document.getElementById('content-name').textContent").startswith(name))
    driver.click("#command-next_content")
    driver.until("and the third", lambda: content() == 2)
    driver.until("the page shows its unit", lambda: driver.run(
        "return document.getElementById('cost-name').textContent") == "Kilotexels")
    driver.run("""const slider = document.getElementById('triangles');
        slider.value = 0; slider.dispatchEvent(new Event('input'));
        slider.dispatchEvent(new Event('change'));""")

    def coarsest():
        detail = status()["detail"]
        return detail["held_cost"] == max(4, round(detail["full_cost"] / 2 ** (detail["steps"] - 1)))
    driver.until("the slider begins at a picture's coarsest step", coarsest)
    driver.click("#command-next_content")
    driver.until("and the first one again", lambda: content() == 0)
    driver.until("what is in a picture's unit is not held for a model", lambda: status()["detail"]["held_cost"] == 0)


def contents(driver):
    tile = "#contents [data-name=%s]"
    seen = "return document.querySelector('%s .thumbnail img')?.naturalWidth || 0"
    driver.until("each content has its picture", lambda: all(
        driver.run(seen % (tile % name)) > 100 for name in ("model", "meadow")))
    driver.until("a file that was shown before is listed", lambda: driver.run(
        "return [...document.querySelectorAll('#contents button')].map(e => e.dataset.name).join()")
        == "model,again,meadow,valley")
    driver.click(tile % "valley")
    driver.until("a tap shows it again", lambda: status()["content"]["name"] == "valley")
    driver.until("and the page marks it", lambda: driver.run(
        "return document.querySelector('%s').ariaPressed" % (tile % "valley")) == "true")
    driver.until("and takes its picture from the wall", lambda: driver.run(seen % (tile % "valley")) > 100)
    pressed = "return document.querySelector('%s').ariaPressed" % (tile % "meadow")
    driver.until("another one is shown", lambda: driver.run(pressed) == "false")
    driver.click(tile % "meadow")
    driver.until("a tap shows the content", lambda: status()["content"]["name"] == "meadow")
    driver.until("and the page marks it", lambda: driver.run(pressed) == "true")
    driver.run("document.querySelector('%s').focus()" % (tile % "model"))
    driver.press("\ue007")
    driver.until("the Enter key shows one as well", lambda: status()["content"]["name"] == "model")


def refuse(driver, least, text):
    """Lets the page's server refuse pictures of at least this width from now on."""
    driver.run("""const [least, error] = arguments;
        window.served = window.served || window.fetch;
        window.fetch = (url, options) => {
            const width = /picture[.]jpg.*width=([0-9]+)/.exec(url);
            return width && Number(width[1]) >= least ?
                Promise.resolve(new Response(JSON.stringify({error}), {status: 503})) : window.served(url, options);
        };""", least, text)


def refusals(driver):
    """The server refuses pictures because others look at too many views and sizes, and a thumbnail does not come."""
    fault = "return document.getElementById('picture-fault').hidden ? '' : document.getElementById('picture-fault').textContent"
    width = "return document.getElementById('picture').naturalWidth"
    driver.run("document.getElementById('screen').scrollIntoView({block: 'center'})")
    driver.until("the picture is shown", lambda: driver.run(width) > 320)
    refuse(driver, 321, "too many sizes")
    driver.until("a smaller picture is shown instead", lambda: driver.run(width) == 320)
    assert driver.run(fault) == "", "it is shown, but: " + driver.run(fault)
    refuse(driver, 1, "too many views")
    driver.until("the picture says what the server says", lambda: driver.run(fault) == "too many views")
    driver.run("window.fetch = window.served")
    driver.until("until it comes again", lambda: driver.run(fault) == "")
    driver.until("as large as before", lambda: driver.run(width) > 320)
    seen = "return [...document.querySelectorAll('#contents .thumbnail img')].map(image => image.src)"
    before = driver.run(seen)
    driver.run("""let failed = false;
        window.fetch = async (url, options) => {
            if (url.startsWith('/thumbnail.jpg') && !failed) {
                failed = true;
                return new Response(JSON.stringify({error: 'not now'}), {status: 503});
            }
            const answer = await window.served(url, options);
            if (url !== '/api/contents') return answer;
            const {contents, shown} = await answer.json();
            for (const content of [...contents, ...shown]) content.thumbnail = content.thumbnail && content.thumbnail + 1000;
            return new Response(JSON.stringify({contents, shown}));
        };""")
    driver.until("every thumbnail is read again, also the one that failed", lambda:
                 len(before) > 1 and len(driver.run(seen)) == len(before) and not set(before) & set(driver.run(seen)))
    driver.run("window.fetch = window.served")


def idle(driver):
    """The page in the states playlist, black and frozen."""
    state = "return document.getElementById('playlist-state').textContent"

    def pressed(selector):
        return driver.run("return document.querySelector('%s').ariaPressed" % selector) == "true"
    driver.until("the playlist is off", lambda: driver.run(state).startswith("Off"))
    driver.click("[data-playlist=on]")
    driver.until("the playlist runs", lambda: status()["playlist"] == "running")
    driver.until("and the page says for how long", lambda: "Plays; the next in" in driver.run(state))
    assert pressed("[data-playlist=on]") and not pressed("[data-playlist=off]")
    before = content()
    driver.click("[data-playlist=next]")
    driver.until("its next content is shown", lambda: content() != before)
    driver.click("[data-playlist=off]")
    driver.until("the playlist is off again", lambda: status()["playlist"] == "off" and pressed("[data-playlist=off]"))
    for button, word in (("#command-blank", "blank"), ("#command-freeze", "frozen")):
        driver.click(button)
        driver.until("the wall is " + word, lambda: status()["shown"] == word and pressed(button))
        driver.click(button)
        driver.until("the picture is shown again", lambda: status()["shown"] == "picture" and not pressed(button))
    driver.click("#contents [data-name=model]")
    driver.until("the model is shown", lambda: content() == 0)
    assert driver.run("return document.getElementById('projectors-none').checkVisibility()"), "projectors from nowhere"


def phone(driver):
    """The page has no code for a phone, since the page listens on loopback only, and says so."""
    driver.run("document.getElementById('phone').click()")
    driver.until("the page says why a phone cannot reach it", lambda: "listens only at 127.0.0.1" in driver.run(
        "return document.getElementById('phone-why').textContent"))
    assert driver.run("return document.getElementById('phone-code').hasAttribute('hidden')"), "a useless code"
    driver.click("#phone-close")
    driver.until("the dialog is closed", lambda: not driver.run("return document.getElementById('phone-dialog').open"))


def labels(driver):
    """No control may be without a text for screen readers and, on a phone, too small for a thumb."""
    nameless = driver.run("""return [...document.querySelectorAll('button, input, select, img, svg')]
        .filter(e => e.checkVisibility() && !e.closest('[aria-hidden=true]') && !(e.ariaLabel || e.alt === '' || e.alt ||
            e.textContent.trim() || (e.labels && e.labels.length)))
        .map(e => e.outerHTML.slice(0, 80))""")
    assert not nameless, "without a label: %s" % nameless
    small = driver.run("""return [...document.querySelectorAll('main button')].filter(e => e.checkVisibility())
        .map(e => [e.textContent.trim() || e.ariaLabel, e.getBoundingClientRect()])
        .filter(([name, box]) => box.height < 40 || box.width < 40).map(([name]) => name)""")
    assert not PHONE or not small, "too small for a thumb: %s" % small


def slides(driver):
    """A slider that is dragged keeps its value, although not every browser gives it the keyboard's focus."""
    driver.run("""document.activeElement.blur();
        const slider = document.getElementById('rate');
        slider.dispatchEvent(new PointerEvent('pointerdown'));
        slider.value = 17; slider.dispatchEvent(new Event('input'));
        window.read = 0;
        window.fetch = async (url, options) => {
            const answer = await window.served(url, options);
            window.read += url === '/api/status';
            return answer;
        };""")
    driver.until("the state was read three times", lambda: driver.run("return window.read") >= 3)
    assert driver.run("return document.getElementById('rate').value") == "17", "the slider sprang back"
    driver.run("""window.fetch = window.served;
        const slider = document.getElementById('rate');
        slider.dispatchEvent(new PointerEvent('pointerup')); slider.dispatchEvent(new Event('change'));""")
    driver.until("it sets the rate when it is let go", lambda: status()["rate_asked"] == 17)
    driver.click("#rate-auto")
    driver.until("auto returns to the configured rate", lambda: status()["rate_asked"] == 10)


def crowded(driver):
    """The page says that its server is flooded by others."""
    banners = "return document.getElementById('banners').textContent"
    driver.run("""window.fetch = (url, options) => url === '/api/status' ?
        Promise.resolve(new Response(JSON.stringify({error: 'too many'}), {status: 429})) : window.served(url, options);""")
    driver.until("the page says that it gets no answers", lambda: "Others ask the page's server for too much" in driver.run(banners))
    driver.run("window.fetch = window.served")
    driver.until("until it gets them again", lambda: "Others ask" not in driver.run(banners))


def stands(driver):
    """Waits until the wall and the page's picture stand still; returns that picture."""
    driver.click("#command-reset_view")
    driver.until("the wall stands still", lambda: status()["full_detail"])
    seen = []

    def same():
        seen.append(pixels(driver))
        return len(seen) > 20 and seen[-1] is not None and all(s == seen[-1] for s in seen[-20:])
    driver.until("so does the page's picture", same)
    driver.run("document.getElementById('screen').scrollIntoView({block: 'center'})")
    return seen[-1]


def moves(driver):
    hint = "return document.getElementById('move-hint').textContent"
    for name, does in (("model", "turn the model"), ("meadow", "move the picture")):
        driver.click("#contents [data-name=%s]" % name)
        driver.until("the page says what a drag does", lambda: does in driver.run(hint))
        before = stands(driver)
        driver.drag("#screen", 100, 20, POINTER)
        driver.until("dragging does: " + does, lambda: difference(pixels(driver) or before, before) > 1)
        before = stands(driver)
        driver.pinch("#screen", 20, 60) if PHONE else driver.wheel("#screen", -300)
        driver.until("two fingers, or the wheel, zoom", lambda: difference(pixels(driver) or before, before) > 1)
    driver.run("""window.moved = 0;
        window.fetch = (url, options) => {
            window.moved += url === '/api/command' && options.body.includes('"move"');
            return window.served(url, options);
        };""")
    driver.hold("[data-notch='-1']", POINTER)
    driver.until("a button that is held goes on", lambda: driver.run("return window.moved") >= 3)
    driver.release()
    driver.run("window.fetch = window.served")
    driver.click("#contents [data-name=model]")
    driver.until("the model is shown", lambda: content() == 0)


def operator_panel(driver):
    """The buttons of the operator's panel work where the page shows them."""
    mode, side = status()["mode"], "return [picture.naturalWidth, picture.naturalHeight]"
    driver.click("[data-view=operator]")
    driver.until("the operator's tile is shown", lambda: (lambda w, h: 3 * w == 4 * h)(*driver.run(side)))
    x, y = map(int, MODE_BUTTON.split())
    right, down = driver.run("""const [x, y] = arguments, screen = document.getElementById('screen');
        screen.scrollIntoView({block: 'center'});
        return fetch('/picture.jpg?view=operator&width=320').then(answer => {
            const [, , , , to_x, to_y] = answer.headers.get('X-Picture-Panel').split(' ').map(Number);
            const [width, height] = answer.headers.get('X-Picture-Size').split(' ').map(Number);
            return [((x - to_x) / width - .5) * screen.clientWidth, ((y - to_y) / height - .5) * screen.clientHeight];
        });""", x, y)
    for wanted in ("fly" if mode == "object" else "object", mode):
        driver.tap("#screen", round(right), round(down), POINTER)
        driver.until("its button switches the mode to " + wanted, lambda: status()["mode"] == wanted)
    driver.click("[data-view=wall]")
    driver.until("the wall is shown again", lambda: (lambda w, h: w == 4 * h)(*driver.run(side)))


def down(driver):
    """When the wall is gone, the page shows nothing of it as present."""
    text = "return document.getElementById(arguments[0]).textContent"
    os.kill(int(WALL_PID), signal.SIGTERM)
    driver.until("the page says that the wall is gone", lambda: "The role wall does not run" in driver.run(text, "banners"))
    for what in ("head-rate", "playlist-state", "rate-value", "triangles-value"):
        assert driver.run(text, what) == "–", what + ": " + driver.run(text, what)
    for what in ("detail-facts", "frame-facts", "frames-legend", "content-name", "outputs"):
        assert driver.run(text, what) == "", what + ": " + driver.run(text, what)
    pressed = driver.run("""return [...document.querySelectorAll('main [aria-pressed=true]')]
        .filter(e => !e.dataset.view && !e.closest('#align-card')).map(e => e.textContent)""")
    assert pressed == [], "still marked: %s" % pressed


def aligns(driver):
    driver.run("document.getElementById('align-plane').scrollIntoView({block: 'center'})")
    driver.until("the output is listed", lambda: driver.run(
        "return document.getElementById('align-output').options.length === 1"))
    state = "return document.getElementById('align-state').textContent"

    def settled():
        return driver.run("return document.getElementById('align-plane').ariaBusy") == "false"
    driver.drag("circle[data-corner=top_right]", -20, 15, POINTER)
    driver.until("a corner is dragged", lambda: "top right moved by -" in driver.run(state))
    driver.until("the wall has moved it", settled)
    while "0 to undo" not in driver.run(state):  # two steps, if a busy machine let the drag rest on its way
        driver.click("#align-undo")
        driver.until("a step is undone", settled)
    assert "moved by 0.00, 0.00" in driver.run(state), "undone, but: " + driver.run(state)
    driver.click("#align-redo")
    driver.until("and done again", lambda: "moved by -" in driver.run(state))
    driver.click("#align-reset")
    driver.until("the output is reset", lambda: "moved by 0.00, 0.00" in driver.run(state))
    driver.run("document.querySelector('circle[data-corner=top_right]').focus()")
    for moved in ("1.00", "2.00"):  # the second press shows that the corner keeps the focus
        driver.press("\ue014")
        driver.until("the arrow key moves the corner", lambda: "moved by %s, 0.00" % moved in driver.run(state))
    driver.click("#align-reset")
    driver.until("the output is reset again", lambda: "moved by 0.00, 0.00" in driver.run(state))
    driver.click("[data-by='1 0']")
    driver.until("an arrow moves the corner by a step", lambda: "moved by 1.00, 0.00" in driver.run(state))
    driver.click("#align-undo")
    driver.run("""const cards = document.getElementById('testcard');
        cards.value = 'grid'; cards.dispatchEvent(new Event('change'));""")
    driver.until("the test card is shown", lambda: "grid" == driver.run(
        "return document.getElementById('testcard').value"))
    driver.run("""const cards = document.getElementById('testcard');
        cards.value = 'off'; cards.dispatchEvent(new Event('change'));""")


def main():
    driver = browser.Driver(390, 844, True) if PHONE else browser.Driver(1440, 1000)
    try:
        unlock(driver)
        looks(driver)
        commands(driver)
        contents(driver)
        refusals(driver)
        idle(driver)
        phone(driver)
        labels(driver)
        slides(driver)
        crowded(driver)
        moves(driver)
        operator_panel(driver)
        aligns(driver)
        driver.run("scrollTo(0, 0)")
        driver.screenshot(os.path.join(FOLDER, "page-%s.png" % SIZE))
        driver.screenshot(os.path.join(FOLDER, "page-%s-whole.png" % SIZE), whole=True)
        wrong = [m for m in driver.messages() if not any(e in m for e in EXPECTED)]
        assert not wrong, "the browser's console: %s" % wrong
        down(driver)
    finally:
        driver.close()
    print("page_browser: done (%s)" % SIZE)


try:
    main()
except (AssertionError, RuntimeError) as error:
    sys.exit("page_browser (%s): %s" % (SIZE, error))
