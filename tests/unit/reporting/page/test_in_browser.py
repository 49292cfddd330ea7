"""The page, opened from the disk in a real browser."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

sync_api = pytest.importorskip("playwright.sync_api", reason="the Python package playwright is not installed")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed")
PHONE = {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with sync_api.sync_playwright() as playwright:
        # In a container, which runs as root, Chromium has no sandbox of its own.
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def untouched(browser: Any, page: Path) -> Iterator[Any]:
    """The page, for tests that only look."""
    context = browser.new_context()
    tab = context.new_page()
    tab.goto(page.as_uri())
    yield tab
    context.close()


@pytest.fixture
def opened(browser: Any, page: Path) -> Iterator[Any]:
    """opened(**options): the page, whose console must stay empty and which must ask for nothing."""
    complaints: list[str] = []
    contexts = []

    def visit(**options: Any) -> Any:
        context = browser.new_context(**options)
        contexts.append(context)
        tab = context.new_page()
        tab.on("console", lambda message: complaints.append(message.text))
        tab.on("pageerror", lambda error: complaints.append(str(error)))
        tab.on("request", lambda request: complaints.extend([request.url] * (not request.url.startswith("data:"))))
        tab.goto(page.as_uri())
        return tab

    yield visit
    for context in contexts:
        context.close()
    assert complaints == [page.as_uri()] * len(contexts)


def column(tab: Any, grid: str, place: int) -> list[str]:
    """The texts of a column, of the rows that are shown."""
    cells = tab.locator(f"#{grid}-table tbody tr:visible td:nth-child({place + 1})")
    return [text.strip() for text in cells.all_inner_texts()]


def menu(tab: Any, grid: str, name: str) -> Any:
    return tab.locator(f"#{grid}-table").get_by_role("combobox", name=name, exact=True)


def test_every_image_has_loaded_and_says_what_it_is(untouched: Any) -> None:
    images = untouched.locator("img")
    facts = images.evaluate_all("all => all.map(i => [i.complete && i.naturalWidth > 0, i.alt])")
    assert len(facts) == 6
    assert all(loaded for loaded, _ in facts)
    assert [alternative for _, alternative in facts] == [
        f"{title}: {robot}"
        for robot in ("All robots", "ARM <made up>", "FINGER <made up>")
        for title in ("Intervals around the paper's model", "An extra one")
    ]


def test_headings_sort_numbers_as_numbers_both_ways(opened: Any) -> None:
    tab = opened()
    heading = tab.locator("#points-table th").nth(4)
    for direction, reverse in (("ascending", False), ("descending", True)):
        heading.get_by_role("button").click()
        assert heading.get_attribute("aria-sort") == direction
        values = [float(text) for text in column(tab, "points", 4)]
        assert len(values) == 16
        assert len(set(values)) > 4
        assert values == sorted(values, reverse=reverse)
    tab.locator("#points-table th").nth(2).get_by_role("button").press("Enter")
    assert heading.get_attribute("aria-sort") is None
    names = [text.removesuffix("deployed").strip() for text in column(tab, "points", 2)]
    assert names == sorted(names)


def test_what_was_not_measured_goes_last_either_way(opened: Any) -> None:
    tab = opened()
    heading = tab.locator("#intervals-table th").nth(9).get_by_role("button")
    for _ in range(2):
        heading.click()
        shown = column(tab, "intervals", 9)
        assert shown == ["2.00"] * 64 + ["–"] * 16


def test_texts_of_numbers_have_their_value(untouched: Any) -> None:
    texts = ["2.89", "91.4 %", "<0.000000001", "-0.5", "infinite"]
    value = "text => valueOf(text) === Infinity ? 'most' : valueOf(text)"
    values = untouched.evaluate(f"texts => texts.map({value})", texts)
    assert values == [2.89, 91.4, 1e-9, -0.5, "most"]


def test_menus_filter_together_and_the_count_follows(opened: Any) -> None:
    tab = opened()
    count = tab.locator("#points-table output")
    assert count.inner_text() == "16 rows, of 64 in all"
    menus = {name: menu(tab, "points", name) for name in ("Robot", "Rows", "Model", "Preset")}
    assert menus["Rows"].input_value() == "test"
    menus["Robot"].select_option("finger")
    menus["Model"].select_option("Gaussian process")
    assert count.inner_text() == "2 rows, of 64 in all"
    assert {text.split()[0] for text in column(tab, "points", 0)} == {"finger"}
    assert column(tab, "points", 3) == ["paper", "tuned"]
    for one in menus.values():
        one.select_option("all")
    assert count.inner_text() == "64 rows"


def test_a_long_table_shows_the_rest_when_asked(opened: Any) -> None:
    tab = opened()
    for name in ("Rows", "Level"):
        menu(tab, "intervals", name).select_option("all")
    assert len(column(tab, "intervals", 0)) == 100
    more = tab.locator("#intervals-table").get_by_role("button", name="Show all")
    more.click()
    assert len(column(tab, "intervals", 0)) == 320
    assert more.is_hidden()


def test_only_tables_scroll_sideways(opened: Any) -> None:
    tab = opened(viewport=PHONE)
    for width in (320, 390, 1280):
        tab.set_viewport_size(PHONE | {"width": width})
        assert tab.evaluate("document.documentElement.scrollWidth") <= width
        # Nothing but what scrolls in a box of its own reaches beyond the screen.
        beyond = tab.evaluate(
            """width => Array.from(document.querySelectorAll("main *, header *, footer *"))
            .filter(e => e.getBoundingClientRect().right > width + 1 && !e.closest(".scroll, pre"))
            .map(e => e.outerHTML.slice(0, 80))""",
            width,
        )
        assert beyond == [], width


def hint(tab: Any, grid: str) -> Any:
    return tab.locator(f"#{grid}-table").get_by_text("Scroll sideways")


@pytest.mark.parametrize("width", [390, 1400, 2600])
def test_a_table_says_that_it_scrolls_exactly_where_it_does(opened: Any, width: int) -> None:
    tab = opened(viewport={"width": width, "height": 900})
    tab.wait_for_timeout(100)
    scrolls = set()
    for grid in ("points", "choice", "intervals", "published-intervals"):
        box = tab.locator(f"#{grid}-table .scroll")
        is_wider = box.evaluate("box => box.scrollWidth > box.clientWidth + 1")
        assert hint(tab, grid).is_visible() == is_wider, grid
        scrolls.add(is_wider)
    assert True in scrolls or width > 390


def test_the_hint_of_a_folded_picture_comes_when_it_is_opened(opened: Any) -> None:
    tab = opened(viewport=PHONE)
    album = tab.locator("details.album").nth(1)
    assert album.get_by_text("Scroll sideways").first.is_hidden()
    album.locator("summary").click()
    album.get_by_text("Scroll sideways").first.wait_for(state="visible")


def test_the_csv_of_a_table_can_be_downloaded(untouched: Any) -> None:
    tab = untouched
    with tab.expect_download() as download:
        tab.locator("#slowest-table").get_by_role("link", name="slowest.csv").click()
    assert download.value.suggested_filename == "slowest.csv"
    assert Path(download.value.path()).read_text(encoding="utf-8").startswith("Job,Robot,Model")
    link = tab.locator("#points-table").get_by_role("link", name="tables/point_metrics.csv")
    assert link.evaluate("a => a.href").endswith("/results/tables/point_metrics.csv")


def test_headings_stay_in_sight_while_a_table_scrolls(opened: Any) -> None:
    tab = opened()
    places = tab.locator("#points-table .scroll").evaluate(
        """box => { box.scrollTop = 300; const top = box.getBoundingClientRect().top;
        return [box.scrollTop, box.querySelector("th").getBoundingClientRect().top - top]; }"""
    )
    assert places[0] > 0
    assert abs(places[1]) < 3


def luminance(colour: str) -> float:
    """Relative luminance (WCAG 2.2) of 'rgb(r, g, b)'."""
    channels = [int(part) / 255 for part in colour.removeprefix("rgb(").removesuffix(")").split(",")]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_all_text_is_readable_in_light_and_dark(opened: Any) -> None:
    tab = opened()
    for scheme in ("light", "dark"):
        tab.emulate_media(color_scheme=scheme)
        check_that_text_is_readable(tab, scheme)


def check_that_text_is_readable(tab: Any, scheme: str) -> None:
    pairs = tab.evaluate(
        """() => { const behind = e => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor;
            if (c !== "rgba(0, 0, 0, 0)") return c; } return "none"; };
        const texts = Array.from(document.querySelectorAll("body *")).filter(e =>
            Array.from(e.childNodes).some(n => n.nodeType === 3 && n.nodeValue.trim()) && e.checkVisibility());
        return texts.map(e => [getComputedStyle(e).color, behind(e)]); }"""
    )
    assert len(set(map(tuple, pairs))) > 5
    for ink, paper in set(map(tuple, pairs)):
        brighter, darker = sorted((luminance(ink), luminance(paper)), reverse=True)
        assert (brighter + 0.05) / (darker + 0.05) >= 4.5, (ink, paper)
    body = luminance(tab.evaluate("getComputedStyle(document.body).backgroundColor"))
    assert (body > 0.8) if scheme == "light" else (body < 0.05)


def test_it_reads_without_scripts(browser: Any, page: Path) -> None:
    context = browser.new_context(java_script_enabled=False)
    tab = context.new_page()
    tab.goto(page.as_uri())
    assert len(column(tab, "points", 0)) == 64
    assert tab.locator("#points-table select").first.is_hidden()
    context.close()


def test_print_shows_what_is_folded(opened: Any) -> None:
    tab = opened()
    tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    tab.emulate_media(media="print")
    assert tab.locator("details").evaluate_all("all => all.every(d => d.open)")
    assert tab.locator("nav").is_hidden()
    assert tab.get_by_text("campaign: made-up").is_visible()
