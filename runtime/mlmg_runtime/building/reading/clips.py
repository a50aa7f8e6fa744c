"""Which clips a configuration names, by patterns and one by one."""

from __future__ import annotations

from pathlib import Path

from mlmg_runtime.building.configuration import ClipSource
from mlmg_runtime.building.reading.table import Table, composed
from mlmg_runtime.building.toml_files import did_you_mean


def read_clips(document: Table) -> tuple[ClipSource, ...]:
    """Return the clips that patterns find, then those of the tables `[clips.NAME]`, which win where names are equal."""
    tables = document.table("clips")
    named = {composed(name): _clip(tables, name) for name in tables}
    library = document.table("library")
    found: dict[str, ClipSource] = {}
    for pattern in library.texts("clips", () if named else ("*.bvh",)):
        for path in _matches(library, pattern):
            name = composed(path.stem)
            if name in named:
                continue
            if name in found and found[name].path.resolve() != path.resolve():
                message = f"two clips are named `{name}`: {found[name].path} and {path}; name one with [clips.NAME]"
                library.fail(message, "clips")
            found.setdefault(name, ClipSource(name, path, library.file.lines.get((*library.at, "clips"))))
    found.update(named)
    if not found:
        library.fail("no clip is named; expected globs or paths of BVH files", "clips")
    return tuple(found.values())


def _matches(library: Table, pattern: str) -> list[Path]:
    folder = library.file.path.parent
    if not any(character in pattern for character in "*?["):
        path = folder / pattern
        if path.is_dir():
            inside = f"{pattern.rstrip('/')}/*.bvh"
            library.fail(f'{path} is a folder, not a clip; for all BVH files in it write "{inside}"', "clips")
        if not path.is_file():
            library.fail(f"there is no clip {path}", "clips")
        return [path]
    try:
        found = sorted(path for path in folder.glob(pattern) if path.is_file())
    except (ValueError, NotImplementedError):
        found = sorted(path for path in Path(pattern).parent.glob(Path(pattern).name) if path.is_file())
    if not found:
        library.fail(f"no clip matches {pattern}; {_what_is_in((folder / pattern).parent)}", "clips")
    return found


def _clip(tables: Table, name: str) -> ClipSource:
    if not isinstance(tables.get(name, None), dict):
        tables.fail(f"[clips.{name}] must be a table with the keys file, frames, mirror", name)
    table = tables.table(name)
    table.expect_keys("file", "frames", "mirror")
    path = table.file.path.parent / str(table.text("file", f"{name}.bvh"))
    if not path.is_file():
        table.fail(f"there is no clip {path}", *(("file",) if "file" in table else ()))
    mirror = table.get("mirror", False)
    if not isinstance(mirror, bool):
        table.fail(f"mirror must be true or false, found {mirror!r}", "mirror")
    return ClipSource(composed(name), path, table.file.lines.get(table.at), _frames(table), mirror)


def _frames(table: Table) -> tuple[int, int] | None:
    frames = table.get("frames", None)
    if frames is None:
        return None
    if not (isinstance(frames, list) and len(frames) == 2 and all(type(frame) is int for frame in frames)):
        table.fail(_wrong_frames(frames), "frames")
    if not 0 <= frames[0] < frames[1]:
        table.fail(_wrong_frames(frames), "frames")
    return frames[0], frames[1]


def _wrong_frames(frames: object) -> str:
    return f"frames must be [first, last + 1] with 0 <= first < last + 1, found {frames!r}"


def _what_is_in(folder: Path) -> str:
    """Return what there is instead of the clips that a pattern should match."""
    if any(character in str(folder) for character in "*?["):
        return "expected BVH files"
    if not folder.is_dir():
        missing = next(path for path in (*reversed(folder.parents), folder) if not path.is_dir())
        near = did_you_mean(missing.name, (path.name for path in missing.parent.iterdir() if path.is_dir()))
        return f"there is no folder {missing}{near}"
    files = sorted(path.name for path in folder.iterdir() if path.suffix.lower() == ".bvh")
    return f"{folder} has no BVH file" if not files else f"{folder} has {len(files)} BVH files, such as {files[0]}"
