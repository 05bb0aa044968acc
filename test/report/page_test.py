#!/usr/bin/python3
"""The HTML page of `evolin report` in a browser without a screen: nothing in the console, tables
sort, every image loads, nothing comes from elsewhere.

Exit status 77 where EVOLIN_FULL is not 1, or Chromium or python3-selenium is not there.
"""

import os
import shutil
import sys
import unittest

from fixtures import (ReportTest, detection, frame_rows, no_detection, pose, repeatability, report)

SKIPPED = 77
LIMIT = 60
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def why_skipped():
    if os.environ.get("EVOLIN_FULL") != "1":
        return "tests in a browser run under scripts/test --full (EVOLIN_FULL=1)"
    if not any(shutil.which(name) for name in BROWSERS) or not shutil.which("chromedriver"):
        return "Chromium and chromedriver are not installed (packages chromium, chromium-driver)"
    try:
        import selenium  # noqa: F401
    except ImportError:
        return "python3-selenium is not installed"
    return ""


def open_browser(folder):
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    options.binary_location = next(filter(None, map(shutil.which, BROWSERS)))
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--user-data-dir=" + os.path.join(folder, "profile"),
                     "--window-size=1280,1600"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    browser.set_page_load_timeout(LIMIT)
    return browser


class PageTest(ReportTest):
    @classmethod
    def setUpClass(cls):
        import tempfile
        cls.profile = tempfile.mkdtemp(prefix="evolin_browser_")
        cls.addClassCleanup(shutil.rmtree, cls.profile, ignore_errors=True)
        cls.browser = open_browser(cls.profile)
        cls.addClassCleanup(cls.browser.quit)

    def open(self, *folders, more=()):
        from evolin_report import command_line
        status = command_line.main([*folders, "-o", self.path("out"), "-q", "--html", *more])
        self.assertEqual(status, 0)
        self.browser.get("file://" + self.path("out", "index.html"))
        self.assertEqual(self.browser.get_log("browser"), [])
        return self.browser

    def tearDown(self):
        self.assertEqual(self.browser.get_log("browser"), [])

    def run_script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def pictures(self, folder, frames):
        """worst_frames.csv with pictures of one colour."""
        from PIL import Image
        os.makedirs(os.path.join(folder, "worst_frames"))
        with open(os.path.join(folder, "worst_frames.csv"), "w") as file:
            file.write("stamp,file,distance,threshold,f_score,true_positives,false_positives,"
                       "misses\n")
            for index in range(1, frames + 1):
                name = "worst_frames/%d.jpg" % index
                Image.new("RGB", (64, 48), (40 * index, 90, 90)).save(os.path.join(folder, name))
                file.write("%d.5,%s,structural,5,0.25,3,4,5\n" % (index, name))

    def full_run(self, name, precision=0.5, frames=5):
        folder = self.run_directory(
            name, report(name, detection=detection(name, precision), pose=pose(),
                         repeatability=repeatability(precision)),
            frames=frame_rows([(index + 1, 10, 10) for index in range(frames)]),
            curves=[{"distance": "structural", "threshold": 10, "recall": 0.1 * step,
                     "precision": 1 - 0.05 * step} for step in range(8)],
            poses=[{"first_stamp": "0.0", "stamp": "1.0", "rotation_error_deg": 0.5,
                    "translation_angle_deg": 2, "translation_error_m": 0.01, "reason": ""}])
        self.pictures(folder, 3)
        return folder

    def images(self):
        """Waits for all of them; a broken one is complete with a width of 0."""
        from selenium.webdriver.support.ui import WebDriverWait
        WebDriverWait(self.browser, LIMIT).until(lambda browser: browser.execute_script(
            "return [...document.querySelectorAll('main img')].every(i => i.complete)"))
        return self.run_script("return [...document.querySelectorAll('main img')]"
                               ".map(i => [i.alt, i.naturalWidth])")

    def column(self, table, name):
        """(index, values as shown) of a column of a table."""
        return self.run_script("""
            const table = document.querySelector('#' + arguments[0] + ' table');
            const heads = [...table.tHead.rows[0].cells].map(head => head.innerText.trim());
            const index = heads.findIndex(head => head.replace(/[^ -~]/g, '').trim()
                                          === arguments[1]);
            return [index, [...table.tBodies[0].rows].map(
                row => row.cells[index].dataset.value)];""", table, name)

    def sort(self, table, name):
        index, _ = self.column(table, name)
        self.assertGreaterEqual(index, 0, name)
        head = self.browser.find_elements("css selector", "#%s thead th" % table)[index]
        head.find_element("css selector", "button").click()
        return self.column(table, name)[1], head.get_attribute("aria-sort")

    def test_a_whole_page(self):
        browser = self.open(self.full_run("a"), self.full_run("b", 0.7), more=["--compare"])
        images = self.images()
        # Five plots, and three worst frames of each run.
        self.assertEqual(len(images), 5 + 6)
        self.assertTrue(all(width > 0 for _, width in images), images)
        self.assertIn("Worst frames of a", browser.page_source)
        self.assertTrue(browser.find_elements("css selector", "#additional table"))

    def test_nothing_comes_from_elsewhere(self):
        browser = self.open(self.full_run("a"))
        self.images()
        loaded = self.run_script("return performance.getEntriesByType('resource').map(e => e.name)"
                                 ".filter(name => !name.startsWith('data:'))")
        self.assertEqual(loaded, [])
        for mark in ("http://", "https://"):
            visible = self.run_script("return [...document.querySelectorAll('[src], [href]')]"
                                      ".map(e => e.src || e.href)")
            self.assertFalse([each for each in visible if str(each).startswith(mark)])
        self.assertTrue(browser.title)

    def test_tables_sort_both_ways_and_what_has_no_value_stays_last(self):
        folders = [self.full_run("a", 0.5), self.full_run("b", 0.9), self.full_run("c", 0.125),
                   self.run_directory("d", report("d", detection=no_detection("d")))]
        self.open(*folders)
        table = "room-sequence-detection"
        values, order = self.sort(table, "sP5")
        self.assertEqual((values, order), (["0.9", "0.5", "0.125", ""], "descending"))
        values, order = self.sort(table, "sP5")
        self.assertEqual((values, order), (["0.125", "0.5", "0.9", ""], "ascending"))
        names, order = self.sort(table, "method")
        self.assertEqual((names, order), (["a", "b", "c", "d"], "ascending"))
        names, _ = self.sort(table, "method")
        self.assertEqual(names, ["d", "c", "b", "a"])

    def test_a_frame_can_be_looked_at_enlarged(self):
        browser = self.open(self.full_run("a"))
        browser.find_element("css selector", ".enlarge").click()
        dialog = browser.find_element("id", "enlarged")
        self.assertTrue(dialog.is_displayed())
        self.assertGreater(self.run_script(
            "return document.querySelector('#enlarged img').naturalWidth"), 0)
        self.assertIn("3 right", dialog.text)
        dialog.find_element("css selector", "button").click()
        self.assertFalse(dialog.is_displayed())

    def test_no_frame_evaluated(self):
        empty = report(detection=no_detection(), association={
            "pairs": 0, "precision": None, "recall": None, "f_score": None,
            "reason": "not evaluated: no matches were received"},
            coverage={"seen": 3, "evaluated": 0, "no_ground_truth": 3},
            timing={}, confidence={"intervals": None, "reason": "not asked for"})
        browser = self.open(self.run_directory("a", empty, frames=[]))
        self.assertEqual(self.images(), [])
        cells = browser.find_elements("css selector", "#room-sequence-detection td")
        self.assertTrue(cells)
        for cell in cells:
            self.assertTrue(cell.text.startswith("–"), cell.text)
        text = browser.find_element("tag name", "main").text
        self.assertIn("no frame was evaluated", text)
        self.assertIn("No curves", text)

    def test_one_frame(self):
        self.open(self.full_run("a", frames=1))
        images = self.images()
        self.assertGreater(len(images), 3)
        self.assertTrue(all(width > 0 for _, width in images), images)

    def test_a_metric_without_value_is_a_dash_with_its_reason(self):
        folder = self.run_directory("a", report("a", detection=detection("a"), pose=pose(5, 4)))
        browser = self.open(folder)
        cell = browser.find_element("css selector", "#room-sequence-pose td")
        self.assertEqual(cell.get_attribute("title"),
                         "no pose was found for 4 of 5 pairs, more than half")
        self.assertEqual(cell.get_attribute("data-value"), "")
        self.assertIn("4 of 5 pairs", browser.find_element(
            "css selector", "#room-sequence-pose .reasons").text)

    def test_names_are_text_and_never_markup(self):
        name = "<script>console.error('run')</script>&\"'"
        browser = self.open(self.run_directory("a", report(name, detection=detection(name))))
        self.assertIn(name, browser.find_element("tag name", "main").text)

    def test_a_benchmark_with_failed_cells(self):
        cells = [({"id": "one", "sequence": "room", "detector": "lsd", "associator": "lbd",
                   "state": "finished"}, report()),
                 ({"id": "two", "sequence": "room", "detector": "hawp", "associator": "lbd",
                   "state": "unavailable", "reason": "no network file"}, None)]
        browser = self.open(self.benchmark("root", cells))
        self.assertIn("unavailable: no network file",
                      browser.find_element("tag name", "main").text)


if __name__ == "__main__":
    reason = why_skipped()
    if reason:
        print(reason)
        sys.exit(SKIPPED)
    unittest.main()
