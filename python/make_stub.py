"""Makes the package's stub: make_stub.py FOLDER_OF_THE_MODULE TEMPLATE STUB.

In the template, a line `**options: TableOptions,` stands for the options of a table of the library,
but for those that the lines before it in the same signature have, and a line `**summaries` for the
classes of summaries.
"""

import re
import sys

_TYPES = {
    "MetricOptions, Metric or str": "MetricOptions | Metric | _Preset | None",
    "Poses, or (vertices, faces)": "Poses | tuple[ArrayLike, _Mesh] | None",
    "three floats": "ArrayLike",
    "list of str": "Sequence[str]",
    "dict of str to float": "Mapping[str, float] | None",
}


def _type(name, kind):
    """The annotation of an option, of its type in numpydoc's form."""
    if kind == "dict":
        return f"{name.capitalize()}Options | None"
    if kind.startswith("{"):
        return "Literal[" + kind.strip("{}").replace("'", '"') + "]"
    if kind.startswith("array"):
        return "ArrayLike | None"
    return _TYPES.get(kind, kind)


def _option_lines(core, table, indent, end, before):
    return [
        f"{indent}{name}: {_type(name, kind)}{end}"
        for name, kind, _default, _meaning in core.options(table)
        if name not in before
    ]


def _summary_lines(core):
    lines = []
    for name, thing in vars(core).items():
        if not hasattr(thing, "_types"):
            continue
        lines.append(f"class {name}:")
        for field, kind in zip(thing._fields, thing._types):
            lines += ["    @property", f"    def {field}(self) -> {kind}: ..."]
        if hasattr(thing, "to_dict"):
            lines.append("    def to_dict(self) -> dict[str, Any]: ...")
        lines.append("")
    return lines[:-1]


def make(core, template):
    lines = []
    before = set()  # names in the signature so far
    for line in template.splitlines():
        if re.match(r" *(def|class) ", line):
            before = set()
        options = re.fullmatch(r"( +)\*\*options: (\w+Options)(,?)", line)
        if options:
            indent, table, comma = options.groups()
            lines += _option_lines(core, table, indent, " = ...," if comma else "", before)
        elif line == "**summaries":
            lines += _summary_lines(core)
        else:
            lines.append(line)
            before.update(re.findall(r"^ +(\w+):", line))
    return "\n".join(lines) + "\n"


def main():
    folder, template, stub = sys.argv[1:]
    sys.path.insert(0, folder)
    import _core

    with open(template, encoding="utf-8") as file:
        text = make(_core, file.read())
    with open(stub, "w", encoding="utf-8") as file:
        file.write(text)


main()
