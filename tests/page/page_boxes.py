"""The overview of four boxes, one of them dead: one click starts the others at the same instant, and a second one the rest."""

from browser import LAPTOP, PHONE, By, Browser

from box_group import SAMPLE_S, Boxes, spread_s
from programs import Scratch, demand

COUNT = 4


def texts(browser, part):
    """Returns the text of this part of each panel."""
    return browser.run("return [...document.querySelectorAll(`.box .${arguments[0]}`)].map((one) => one.textContent)", part)


def stop_all(browser):
    browser.driver.find_element(By.ID, "stop").click()
    browser.driver.find_element(By.ID, "stop-all-yes").click()


# Refused at first: the dead box, all boxes under an address that they do not know, and the token of the first box at another one, which then gives out its own.
with (Scratch() as scratch,
      Browser(allowed_errors=("ERR_CONNECTION_REFUSED", "403 (Forbidden)", "409 (Conflict)", "CORS policy", "ERR_FAILED"),
              may_ask={"localhost"}, rules="MAP localhost 127.0.0.1, MAP * ~NOTFOUND, EXCLUDE 127.0.0.1") as page):
    boxes = Boxes(scratch, COUNT)
    dead = boxes.sessions[-1]
    boxes.kill(dead)
    page.driver.get(f"{boxes.urls[0]}/boxes")
    page.wait_for_text("summary", "3 of 4 boxes have data")
    troubles = texts(page, "trouble")
    demand(f"the dead box says that it does not answer: {troubles}", "does not answer" in troubles[-1])
    page.driver.find_element(By.ID, "site").send_keys("No.1")
    page.driver.find_element(By.ID, "start").click()
    page.wait_for_text("order-answer", "3 of 4 boxes did it, at ")
    starts = [session.status()["occupation"]["start"] for session in boxes.sessions[:-1]]
    demand(f"one click started three boxes at the same instant, within {spread_s(starts)} s", spread_s(starts) <= SAMPLE_S)
    page.wait_for("each box shows the word of its signal", lambda: texts(page, "word") == [*["KEEP OFF"] * (COUNT - 1), "NO DATA"], seconds=40)
    demand("and its sentence", all("No.1: set-up 1 of" in one for one in texts(page, "sentence")[:-1]))
    for size in (LAPTOP, PHONE):
        page.resize(size)
        page.demand_readable(f"overview at {size[0]} px")
        page.shot(f"boxes-{size[0]}")
    boxes.revive(dead)
    dead.ctl("start", "No.2")
    page.driver.find_element(By.ID, "repeat").click()
    page.wait_for_text("order-answer", "0 of 1 boxes did it")
    demand(f"the box that has another stay says so: {texts(page, 'answer')[-1]}", "No.2" in texts(page, "answer")[-1])
    demand("the stays of the three others are as before",
           starts == [session.status()["occupation"]["start"] for session in boxes.sessions[:-1]])
    stop_all(page)
    page.wait_for_text("order-answer", "4 of 4 boxes did it, at ")
    demand("no stay runs any more", all(session.status()["occupation"] is None for session in boxes.sessions))
    # A box refuses an order, and carries it out when asked again with the same instant.
    dead.ctl("start", "No.2")
    page.driver.find_element(By.ID, "start").click()
    page.wait_for_text("order-answer", "3 of 4 boxes did it, at ")
    dead.ctl("discard")
    page.driver.find_element(By.ID, "repeat").click()
    page.wait_for_text("order-answer", "1 of 1 boxes did it, at ")
    starts = [session.status()["occupation"]["start"] for session in boxes.sessions]
    demand(f"repeated, the last one started at the instant of the others, within {spread_s(starts)} s", spread_s(starts) <= SAMPLE_S)
    stop_all(page)
    page.wait_for_text("order-answer", "4 of 4 boxes did it, at ")
    # Under an address that the boxes do not know none of them answers, and the page says why.
    page.driver.get(f"{boxes.urls[0].replace('127.0.0.1', 'localhost')}/boxes")
    page.wait_for_text("other-address", f"Open it as: {boxes.urls[0]}/boxes")
    page.driver.find_element(By.CSS_SELECTOR, "#other-address a").click()
    page.wait_for_text("summary", "4 of 4 boxes have data")
    page.driver.get(boxes.urls[0])
    page.driver.find_element(By.ID, "boxes-link").click()
    page.wait_for_text("summary", "4 of 4 boxes have data")
    boxes.end()
