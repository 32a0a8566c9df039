"""The reference of the case file, from its JSON Schema."""

import json


def page(schema):
    """The page: a section per part of a case, with a table of its keys."""
    schema = json.loads(schema)
    return Reference(schema["$defs"]).page(schema)


class Reference:
    def __init__(self, definitions):
        self.definitions = definitions
        #: Definitions with keys of their own that tables have named and that still need a section, in order.
        self.waiting = []
        self.done = set()
        #: The keys of the tables whose sections are those of these definitions.
        self.tables = {}

    def page(self, schema):
        lines = [
            "# Case file",
            "",
            "A case file is TOML. Every quantity carries its unit as text (`\"0.5 mm\"`); a bare number is SI. This page is made from "
            "the schema, which `asperity schema` prints and editors use for completion. Bold keys are required. [How to](../howto/index.md) and the "
            "[gallery](../gallery.md) have whole cases.",
            "",
        ]
        self.tables = {name: key for key, value in schema["properties"].items() if (name := self.target(value))}
        for key, value in schema["properties"].items():
            name = self.target(value)
            if name is None:
                lines += [f"## {key}", "", f"{text(value)}", "", *example(key, value), ""]
                continue
            heading = f"[[{key}]]" if value.get("type") == "array" else f"[{key}]"
            needed = " Required." if key in schema.get("required", []) else ""
            lines += [f"## `{heading}` {{ #{key} }}", "", text(value) + needed, ""]
            self.done.add(name)
            lines += self.body(self.definitions[name], 3)
        lines += ["## Parts", "", "What the tables above name.", ""]
        while self.waiting:
            name = self.waiting.pop(0)
            if name not in self.done:
                self.done.add(name)
                lines += [f"### {words(name)} {{ #{name.lower()} }}", "", *self.body(self.definitions[name], 4)]
        return "\n".join(lines) + "\n"

    def body(self, definition, level):
        """Description, forms and keys of an object."""
        lines = paragraph(definition)
        forms = [self.resolved(form) for form in definition.get("oneOf", []) + definition.get("anyOf", [])]
        plain = [form for form in forms if "properties" not in form]
        if values := [value for form in plain for value in choices(form)]:
            told = [f"- `{form['const']}`: {text(form)}" for form in plain if "const" in form and text(form)]
            lines += ["One of " + ", ".join(f"`{value}`" for value in values) + ".", "", *told, ""]
        for form in plain:
            if not choices(form) and text(form):
                lines += [f"- {text(form)}", ""]
        if "properties" in definition:
            lines += self.keys(definition)
        for form in forms:
            if "properties" in form:
                lines += [f"{'#' * level} {title(form)}", "", *paragraph(form), *self.keys(form)]
        return lines

    def keys(self, definition):
        required = definition.get("required", [])
        rows = ["| key | value | meaning |", "|---|---|---|"]
        for key, value in definition["properties"].items():
            if "const" in value:
                continue
            name = f"**`{key}`**" if key in required else f"`{key}`"
            rows.append(f"| {name} | {self.kind(value)} | {cell(text(value))}{cell(inline(value))} |")
        return [*rows, ""]

    def kind(self, value):
        """What a key takes, linked where a section describes it."""
        if "$ref" in value:
            name, definition = self.target(value), self.resolved(value)
            if described(definition):
                if name not in self.tables and name not in self.done and name not in self.waiting:
                    self.waiting.append(name)
                return f"[{words(name)}](#{self.tables.get(name, name.lower())})"
            if values := choices(definition):
                return cell(" \\| ".join(f"`\"{v}\"`" for v in values))
            return words(name)
        if value.get("type") == "array":
            return f"list of {self.kind(value['items'])}" if value.get("items") else "list"
        if values := choices(value):
            return " \\| ".join(f"`\"{v}\"`" for v in values)
        if forms := value.get("anyOf") or value.get("oneOf"):
            return " or ".join(dict.fromkeys(self.kind(form) for form in forms if form.get("type") != "null"))
        kinds = value.get("type", "value")
        kinds = [k for k in ([kinds] if isinstance(kinds, str) else kinds) if k != "null"]
        plain = {"string": "text", "boolean": "true or false", "integer": "whole number", "number": "number", "object": "table"}
        return " or ".join(plain.get(kind, kind) for kind in kinds)

    def target(self, value):
        """The name of the definition that a value, or the values of a list, refer to."""
        reference = value.get("$ref") or value.get("items", {}).get("$ref")
        return reference.rsplit("/", 1)[1] if reference else None

    def resolved(self, value):
        return self.definitions[self.target(value)] if "$ref" in value else value


def described(definition):
    """Whether a definition needs a section: it has keys, or forms with keys, or choices that are explained."""
    forms = definition.get("oneOf", []) + definition.get("anyOf", [])
    return "properties" in definition or any("properties" in f or "$ref" in f for f in forms) or any(
        f.get("description") and "const" in f for f in forms
    )


def choices(value):
    if "const" in value:
        return [value["const"]]
    if "enum" in value:
        return [v for v in value["enum"] if v is not None]
    forms = value.get("oneOf", []) + value.get("anyOf", [])
    return [v for f in forms for v in choices(f)] if forms and all("const" in f or "enum" in f for f in forms) else []


def title(form):
    """A form by the key that tells it from others: kind = "sphere"."""
    for key, value in form["properties"].items():
        if "const" in value:
            return f'{key} = "{value["const"]}"'
    return "with " + ", ".join(f"`{key}`" for key in form.get("required", list(form["properties"])[:2]))


def words(name):
    """PositiveLength -> positive length."""
    spaced = "".join(f" {c.lower()}" if c.isupper() else c for c in name).strip()
    return spaced.removesuffix(" number").rstrip("0123456789")


def text(value):
    return " ".join(value.get("description", "").split())


def paragraph(value):
    return [text(value), ""] if text(value) else []


def cell(content):
    return content.replace("\\|", "\0").replace("|", "\\|").replace("\0", "\\|")


def toml(value):
    """A value as TOML writes it on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return json.dumps(value, ensure_ascii=False)


def inline(value):
    return "".join(f"<br>`{toml(example)}`" for example in value.get("examples", [])[:1])


def example(key, value):
    return ["```toml", *(f"{key} = {toml(example)}" for example in value.get("examples", [])[:1]), "```"]
