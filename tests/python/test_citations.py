# SPDX-License-Identifier: Apache-2.0
"""What the sources and pages cite is there: sections of docs/methods.md, linked files, and what the pages say of files.

METHODS is docs/methods.md wherever it is cited, as METHODS §5.2 or METHODS section 5.2. Of closed forms 8.4, §8.4 and
section 8, oracle 4 are one. In the pages `engine/photons/gather.h`: `find_radii` says that the word stands in the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
METHODS = ROOT / "docs" / "methods.md"
FOLDERS = ("bindings", "cmake", "docs", "engine", "python", "scenes", "shaders", "tests")
SUFFIXES = {".cmake", ".comp", ".cpp", ".glsl", ".h", ".md", ".photon", ".py"}

# A line's end within a comment, so that a citation may run over it.
LINE_END = re.compile(r"\n[ \t]*(?://|#|\*)?[ \t]*")
NUMBER = r"\d+(?:\.\d+)?"
JOINT = r"(–|,? to |,? and |, (?:oracle )?)(?=\d)"
LIST = rf"({NUMBER}(?:{JOINT.replace('(', '(?:', 1)}{NUMBER})*)"
# METHODS, as a link or with one; variables of that name are none.
CITED = re.compile(r"\bMETHODS\b(?:\]\([^)]*\)|, \[methods\.md\]\([^)]*\),)?(?!(?: =|[:\[\]]))")
SECTION = re.compile(rf" (?:§|sections? )?{LIST}")
EQUATION = re.compile(r"(?: section \d+,)? (?:eq\. |equations? |\()(\d)(?: and (\d))?")
SIGN = re.compile(rf"§({NUMBER})")
NAMED = re.compile(rf"methods\.md\)?, section ({NUMBER})")


def read_sources() -> Iterator[Path]:
    """All files that may cite."""
    for folder in FOLDERS:
        yield from (path for path in (ROOT / folder).rglob("*") if path.suffix in SUFFIXES and path != Path(__file__))
    yield from ROOT.glob("*.md")


def list_sections(methods: str) -> set[str]:
    """Numbers of sections and closed forms; of formulas as (1)."""
    headings = re.findall(rf"^#{{2,3}} ({NUMBER})\.? ", methods, re.MULTILINE)
    forms = re.findall(rf"^- \*\*({NUMBER})\*\* ", methods, re.MULTILINE)
    formulas = re.findall(r"^    .*  (\(\d\))(?: \[SJ09\])?$", methods, re.MULTILINE)
    return {*headings, *forms, *formulas}


def expand_numbers(text: str) -> set[str]:
    """Sections of "3 to 5", "5.3, 5.4" and "8, oracle 4"."""
    parts = re.split(JOINT, text)
    found = {parts[0]}
    for before, joint, number in zip(parts[:-2:2], parts[1::2], parts[2::2], strict=True):
        if joint.strip() in {"–", "to"} and "." not in before + number:
            found |= {str(section) for section in range(int(before), int(number) + 1)}
        elif joint.startswith(", ") and "." not in parts[0] + number:
            found.add(f"{parts[0]}.{number}")
        else:
            found.add(number)
    return found


def find_citations(text: str) -> set[str]:
    """Sections that a text cites; "" where it says METHODS and no section."""
    text = LINE_END.sub(" ", text)
    found = {*SIGN.findall(text), *NAMED.findall(text)}
    for cited in CITED.finditer(text):
        section, equation = SECTION.match(text, cited.end()), EQUATION.match(text, cited.end())
        found |= expand_numbers(section[1]) if section else set()
        found |= {f"({number})" for number in equation.groups() if number} if equation else set()
        found |= set() if section or equation else {""}
    return found


def strip_code(page: str) -> str:
    """A page without blocks and spans of code, which hold brackets of their own."""
    page = re.sub(r"^```.*?^```", "", page, flags=re.MULTILINE | re.DOTALL)
    page = re.sub(r"^(?: {4}|\t).*$", "", page, flags=re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "`", page)


def find_links(page: str) -> list[str]:
    """Targets of links and pictures, but for addresses elsewhere."""
    targets = re.findall(r"\]\(([^)\s]+)\)", strip_code(page))
    return [target for target in targets if not re.match(r"[a-z]+:", target)]


def list_anchors(page: str) -> set[str]:
    """Names by which links reach headings: lower case, blanks as hyphens, without other marks."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", page, flags=re.MULTILINE | re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def find_broken_links(path: Path) -> list[str]:
    """Links of a page that lead nowhere."""
    broken = []
    for target in find_links(path.read_text(encoding="utf-8")):
        name, _, anchor = target.partition("#")
        page = path.parent / name if name else path
        if not page.exists() or (anchor and anchor not in list_anchors(page.read_text(encoding="utf-8"))):
            broken.append(target)
    return broken


def find_false_places(page: str, root: Path) -> list[str]:
    """Files that a page names and that are not there, and words that it says stand in them."""
    folders = "|".join(FOLDERS)
    false = []
    for name, word in re.findall(rf"`((?:{folders})/[\w./-]+)`(?:: `(\w+)`)?", page):
        path = root / name
        if not path.exists():
            false.append(name)
        elif word and not re.search(rf"\b{word}\b", path.read_text(encoding="utf-8")):
            false.append(f"{name}: {word}")
    return false


PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "scenes").rglob("*.md"))]


def test_cited_sections_are_in_the_methods() -> None:
    sections = list_sections(METHODS.read_text(encoding="utf-8"))
    missing = {
        f"{path.relative_to(ROOT)}: METHODS {section}"
        for path in read_sources()
        for section in find_citations(path.read_text(encoding="utf-8", errors="replace")) - sections
    }
    # The page says at its top, and for contributors, what METHODS is.
    assert missing <= {"docs/methods.md: METHODS ", "CONTRIBUTING.md: METHODS "}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(path: Path) -> None:
    assert find_broken_links(path) == []


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_named_files_are_there(path: Path) -> None:
    assert find_false_places(path.read_text(encoding="utf-8"), ROOT) == []


@pytest.mark.parametrize(
    ("text", "sections"),
    [
        ("// as in METHODS §5.2.", {"5.2"}),
        ("# (METHODS sections 3 to 5)", {"3", "4", "5"}),
        ("(METHODS §3–5; more)", {"3", "4", "5"}),
        ("METHODS 5.3, 5.4).", {"5.3", "5.4"}),
        ("METHODS section 8, oracle 4, and METHODS §8.8", {"8", "8.4", "8.8"}),
        ("(METHODS section 8, 5) summed", {"8", "8.5"}),
        ("// beyond METHODS\n// section 99: more", {"99"}),
        ("METHODS section 3, equations 1 and 2.", {"3", "(1)", "(2)"}),
        ("METHODS eq. 2, METHODS (5)", {"(2)", "(5)"}),
        ("[METHODS](../docs/methods.md) section 7:", {"7"}),
        ("([methods.md](methods.md), section 9)", {"9"}),
        ("as METHODS says", {""}),
        ("**METHODS[method]; METHODS: dict = {}; METHODS = 1", set()),
        ("[SJL15] section 5.2", set()),
    ],
)
def test_citations_are_read(text: str, sections: set[str]) -> None:
    assert find_citations(text) == sections


def test_sections_are_read() -> None:
    page = (
        "# Methods\n## 3. Relaxation\n    f = x   (1) [SJ09]\n    g = y   (2)\n### 5.1 Gradient\n- **8.4** A circle.\n"
    )
    assert list_sections(page) == {"3", "(1)", "(2)", "5.1", "8.4"}


def test_broken_links_are_found(tmp_path: Path) -> None:
    (tmp_path / "there.md").write_text("# The way in\n```\n# no heading\n```\n")
    page = tmp_path / "page.md"
    page.write_text(
        "# Here\n[a](there.md) [b](there.md#the-way-in) [c](#here) [d](https://example.org/gone) `x[0](gone)`\n"
        "[e](gone.md) [f](there.md#no-heading) ![g](gone.png) [h](#there)\n"
    )
    assert find_broken_links(page) == ["gone.md", "there.md#no-heading", "gone.png", "#there"]


def test_false_places_are_found(tmp_path: Path) -> None:
    (tmp_path / "engine").mkdir()
    (tmp_path / "engine" / "a.h").write_text("void find_all();\n")
    page = "`engine/a.h`: `find_all`, `engine/a.h`: `find`, `engine/b.h` and `other/b.h`, `engine/`"
    assert find_false_places(page, tmp_path) == ["engine/a.h: find", "engine/b.h"]
