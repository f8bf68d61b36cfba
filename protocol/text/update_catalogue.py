#!/usr/bin/env python3
"""Brings the catalogues protocol/text/*.po in line with the texts in the sources, and says what is still to be translated.

usage: update_catalogue.py [--check]

Texts are the first arguments of tr(), message() and marked() in C++, of tr() in the page's scripts, and the texts of
the page itself.  New ones are added with an empty translation, and those that no source has any more are removed.
--check changes nothing.  Exit status 1: a text is missing in a catalogue, not translated or used no more, or its translation
has other places for arguments.
"""

import html.parser
import pathlib
import re
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
CATALOGUES = sorted((TOP / "protocol" / "text").glob("*.po"))
PAGES = [TOP / "daemon" / "page" / "assets" / name for name in ("index.html", "boxes.html")]
KEYWORDS = ["--keyword", "--keyword=tr:1", "--keyword=message:1", "--keyword=marked:1"]
ATTRIBUTES = ("title", "aria-label", "placeholder")
SILENT = {"script", "style", "title"}


class PageTexts(html.parser.HTMLParser):
    """Collects the texts of a page as language.js translates them: an element that has only <b> inside as one text, else
    each text node by itself."""

    VOID = {"meta", "link", "input", "path", "circle", "use", "text"}

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.texts, self.open = [], []

    def handle_starttag(self, tag, attributes):
        self.texts += [value for name, value in attributes if name in ATTRIBUTES and value]
        is_bold = tag == "b" and "id" not in dict(attributes)
        if self.open and not is_bold:
            self.open[-1]["is_whole"] = False
        if is_bold:
            self.add("<b>")
        elif tag not in self.VOID:
            self.open.append({"tag": tag, "parts": [[]], "is_whole": True})
        if not is_bold and len(self.open) > 1 and tag not in self.VOID:
            self.open[-2]["parts"].append([])
        elif tag in self.VOID and self.open:
            self.open[-1]["parts"].append([])

    handle_startendtag = handle_starttag

    def handle_endtag(self, tag):
        if tag in self.VOID or not self.open:
            return None
        if tag == "b" and self.open[-1]["tag"] != "b":
            return self.add("</b>")
        element = self.open.pop()
        if element["tag"] not in SILENT:
            parts = ["".join(part) for part in element["parts"]]
            if not element["is_whole"]:
                parts = [piece for part in parts for piece in re.split("</?b>", part)]
            self.texts += [" ".join(part.split()) for part in parts]
        return None

    def handle_data(self, data):
        self.add(data)

    def add(self, text):
        if self.open:
            self.open[-1]["parts"][-1].append(text)


def is_language(text):
    """Returns False for texts without words: dashes, units and the names of axes."""
    return re.search("[A-Za-z]{3}", re.sub("</?b>", "", text)) is not None and text not in ("a351", "UTC")


def page_texts():
    found = set()
    for page in PAGES:
        parser = PageTexts()
        parser.feed(page.read_text())
        found |= {text for text in parser.texts if is_language(text)}
    return sorted(found)


def extracted(folder):
    """Returns a file with all texts of the sources."""
    def sources(ending, *rooms):
        return sorted(str(file.relative_to(TOP)) for room in rooms for file in (TOP / room).rglob(f"*.{ending}"))
    quoted = [text.replace("\\", "\\\\").replace('"', '\\"') for text in page_texts()]
    page = folder / "index.html"
    page.write_text("".join(f'tr("{text}");\n' for text in quoted))
    template = folder / "texts.pot"
    common = ["xgettext", "--from-code=UTF-8", "--add-location=file", "--package-name=a351", f"--output={template}", *KEYWORDS]
    subprocess.run([*common, "--language=C++", *sources("cpp", "protocol", "daemon", "corrector"), *sources("hpp", "daemon", "corrector")],
                   cwd=TOP, check=True)
    subprocess.run([*common, "--join-existing", "--language=JavaScript", *sources("js", "daemon")], cwd=TOP, check=True)
    subprocess.run([*common, "--join-existing", "--language=C++", "index.html"], cwd=folder, check=True)
    # xgettext takes "% o" for a format of printf, but places for arguments are those of fmt.
    template.write_text(re.sub(r"^#, c-format\n", "", template.read_text(), flags=re.MULTILINE))
    return template


def entries(file):
    """Returns {text: translation} of a catalogue, without its header."""
    plain = subprocess.run(["msgcat", "--no-wrap", "--no-location", str(file)], capture_output=True, text=True, check=True).stdout
    found, key, parts = {}, None, {}
    for line in plain.splitlines() + [""]:
        match = re.match(r'(msgid|msgstr) "(.*)"$', line)
        if match:
            key = match[1]
            parts[key] = match[2]
        elif line.startswith('"'):
            parts[key] += line[1:-1]
        elif not line and parts:
            if parts["msgid"]:
                found[parts["msgid"]] = parts["msgstr"]
            parts = {}
    return found


def places(text):
    """Returns the numbers of the arguments that a text has places for, sorted."""
    found = [match[1] for match in re.finditer(r"\{(\d*)(?::[^}]*)?\}", text)]
    return sorted(int(number) if number else i for i, number in enumerate(found))


def troubles():
    """Returns what is wrong with the catalogues, one line each."""
    with tempfile.TemporaryDirectory() as folder:
        wanted = entries(extracted(pathlib.Path(folder)))
    return [f"{catalogue.name}: {line}" for catalogue in CATALOGUES for line in troubles_of(catalogue, wanted)]


def troubles_of(catalogue, wanted):
    present = entries(catalogue)
    lines = [f"not in the catalogue: {text}" for text in wanted if text not in present]
    lines += [f"used no more: {text}" for text in present if text not in wanted]
    for text, translation in present.items():
        if not translation:
            lines.append(f"not translated: {text}")
        elif places(text) != places(translation):
            lines.append(f"other places for arguments: {text} -> {translation}")
        elif text.count("<b>") != translation.count("<b>"):
            lines.append(f"another number of <b>: {text} -> {translation}")
        elif (text[0] == " ") != (translation[0] == " ") and text[0] == " " and translation[0].isascii() and translation[0].isalnum():
            lines.append(f"no blank at the begin: {text} -> {translation}")
    if ", fuzzy" in catalogue.read_text():
        lines.append("an entry is marked fuzzy: check it and remove the mark")
    return lines


def update():
    with tempfile.TemporaryDirectory() as folder:
        template = extracted(pathlib.Path(folder))
        for catalogue in CATALOGUES:
            subprocess.run(["msgmerge", "--quiet", "--update", "--backup=none", "--no-fuzzy-matching", "--add-location=file",
                            "--sort-by-file", str(catalogue), str(template)], check=True)
            subprocess.run(["msgattrib", "--no-obsolete", "--sort-by-file", "--add-location=file", f"--output-file={catalogue}",
                            str(catalogue)], check=True)


if __name__ == "__main__":
    if sys.argv[1:] != ["--check"]:
        update()
    found = troubles()
    print("\n".join(found) if found else "\n".join(f"{one.name}: {len(entries(one))} texts, all translated" for one in CATALOGUES))
    sys.exit(bool(found))
