from pathlib import Path

import pytest

from mlmg_runtime.building.configuration import LibraryConfiguration, Threshold, check_start
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.errors import ConfigurationError

CLIPS = ("Idle_01", "Walk_01", "Walk_02", "sub/Walk_01")
KEYS = "library, clips, graph, tags, groups, transitions"
GRAPH_KEYS = "name, joints, without, window, threshold, metric, weights, blend, motions"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with a few clips, which are not read here."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "empty").mkdir()
    for clip in CLIPS:
        (tmp_path / f"{clip}.bvh").write_text("", encoding="utf-8")
    return tmp_path


def read(folder: Path, text: str | bytes) -> LibraryConfiguration:
    path = folder / "library.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_configuration(path)


def graph(*lines: str) -> str:
    return "\n".join(("[[graph]]", 'name = "Full-Body"', *lines))


def rules(*lines: str) -> str:
    return "\n".join(("[[transitions]]", *lines))


# Text of the configuration, line of the mistake, message; DIR is the configuration's folder.
MISTAKES = [
    ("[library", 1, "not valid TOML: Expected ']' at the end of a table declaration"),
    ('[library]\nclips = ["*.bvh"\n\n', 3, "not valid TOML: Unclosed array"),
    ('[library]\nup = "y"\nup = "z"', 3, "not valid TOML: this key or table has been given before"),
    (b"[library]\n# caf\xe9\n", 2, "found bytes that are not UTF-8; a configuration is a UTF-8 text"),
    (
        "libary = 3",
        1,
        f"unknown key `libary`; expected one of {KEYS}; did you mean `library`?",
    ),
    ("library = 3", 1, "library must be a table, found 3"),
    (
        '[library]\nclip = ["*.bvh"]',
        2,
        "unknown key `clip`; expected one of clips, frame_rate, up, start; did you mean `clips`?",
    ),
    ('[library]\nclips = "*.bvh"', 2, 'clips must be a list of texts, as in ["*.bvh"], found a text alone'),
    ("[library]\nclips = [1]", 2, "clips must be a list of texts, found [1]"),
    ("[library]\nclips = []", 2, "no clip is named; expected globs or paths of BVH files"),
    (
        '[library]\nclips = ["*.bhv"]',
        2,
        "no clip matches *.bhv; DIR has 3 BVH files, such as Idle_01.bvh",
    ),
    (
        '[library]\nclips = ["*.bvh", "sbu/*.bvh"]',
        2,
        "no clip matches sbu/*.bvh; there is no folder DIR/sbu; did you mean `sub`?",
    ),
    ('[library]\nclips = ["sub/x/*.bvh"]', 2, "no clip matches sub/x/*.bvh; there is no folder DIR/sub/x"),
    ('[library]\nclips = ["empty/*.bvh"]', 2, "no clip matches empty/*.bvh; DIR/empty has no BVH file"),
    ('[library]\nclips = ["*/*/*.bvh"]', 2, "no clip matches */*/*.bvh; expected BVH files"),
    ('[tag.Full-Body]\nWalk_01 = ["WALK"]', 1, f"unknown key `tag`; expected one of {KEYS}; did you mean `tags`?"),
    (
        '[library]\nclips = ["sub"]',
        2,
        'DIR/sub is a folder, not a clip; for all BVH files in it write "sub/*.bvh"',
    ),
    ('[library]\nclips = ["Walk_9.bvh"]', 2, "there is no clip DIR/Walk_9.bvh"),
    (
        '[library]\nclips = ["*.bvh", "sub/*.bvh"]',
        2,
        "two clips are named `Walk_01`: DIR/Walk_01.bvh and DIR/sub/Walk_01.bvh; name one with [clips.NAME]",
    ),
    ("[library]\nframe_rate = 0", 2, "frame_rate must be a number from 1 to 10000, found 0"),
    ("[library]\nframe_rate = 1e-9", 2, "frame_rate must be a number from 1 to 10000, found 1e-09"),
    ("[library]\nframe_rate = nan", 2, "frame_rate must be a number from 1 to 10000, found nan"),
    ('[library]\nframe_rate = "30"', 2, "frame_rate must be a number from 1 to 10000, found '30'"),
    ('[library]\nup = "x"', 2, "up must be one of y, z, found 'x'"),
    ("[library]\nstart = 4", 2, "start must be a text, found 4"),
    ("clips = 3", 1, "clips must be a table, found 3"),
    ("[clips]\nBoxing = 3", 2, "[clips.Boxing] must be a table with the keys file, frames, mirror"),
    (
        '[clips.Boxing]\nfil = "Walk_01.bvh"',
        2,
        "unknown key `fil`; expected one of file, frames, mirror; did you mean `file`?",
    ),
    ('\n[clips.Boxing]\nfile = "raw/Box.bvh"', 3, "there is no clip DIR/raw/Box.bvh"),
    ("\n[clips.Boxing]\nmirror = true", 2, "there is no clip DIR/Boxing.bvh"),
    *(
        (
            f"[clips.Walk_01]\nframes = {frames}",
            2,
            f"frames must be [first, last + 1] with 0 <= first < last + 1, found {frames}",
        )
        for frames in ("[10, 5]", "[5, 5]", "[-1, 5]", "[1.0, 5]", "[1, 2, 3]", "5")
    ),
    ('[clips.Walk_01]\nmirror = "yes"', 2, "mirror must be true or false, found 'yes'"),
    ('[graph]\nname = "Full-Body"', 1, "graphs are written as [[graph]] tables, one a graph"),
    ("graph = []", 1, "graphs are written as [[graph]] tables, one a graph"),
    ("[[graph]]\nwindow = 3", 1, "a graph must have a name"),
    ('[[graph]]\nname = ""', 2, "a graph must have a name"),
    ("[[graph]]\nname = 3", 2, "name must be a text, found 3"),
    (
        '[[graph]]\nname = "Sub"',
        2,
        "no graph can be named `Sub`: in a script that word stands for the graph below another",
    ),
    (
        '[[graph]]\nname = "Body"\n[[graph]]\njoints = ["Spine"]\nname = "SUB"',
        5,
        "no graph can be named `SUB`: in a script that word stands for the graph below another",
    ),
    (graph("", "[[graph]]", 'name = "Full-Body"'), 4, "two graphs are named `Full-Body`"),
    (graph("windows = 20"), 3, f"unknown key `windows`; expected one of {GRAPH_KEYS}; did you mean `window`?"),
    (graph("window = 1"), 3, "window must be a number of frames from 2 to 1000, found 1"),
    (graph("window = 20.0"), 3, "window must be a number of frames from 2 to 1000, found 20.0"),
    (graph("window = true"), 3, "window must be a number of frames from 2 to 1000, found True"),
    (graph('joints = "Spine"'), 3, 'joints must be a list of texts, as in ["Spine"], found a text alone'),
    (graph("without = [1]"), 3, "without must be a list of texts, found [1]"),
    *(
        (
            graph(f"threshold = {written}"),
            3,
            f'threshold must be "auto", a number above 0 or {{ quantile = 0.01 }}, found {found}',
        )
        for written, found in [
            ('"strict"', "'strict'"),
            ("0", "0"),
            ("-1.5", "-1.5"),
            ("inf", "inf"),
            ("true", "True"),
            ("{ quantile = 2 }", "{'quantile': 2}"),
            ("{ quantile = 0 }", "{'quantile': 0}"),
            ("{ quantil = 0.1 }", "{'quantil': 0.1}"),
        ]
    ),
    (graph('blend = "smooth"'), 3, "blend must be one of c1, linear, found 'smooth'"),
    (
        graph("weights = { Hand = -1 }"),
        3,
        "weights must be a table of joint = number, none below 0, found {'Hand': -1}",
    ),
    (
        graph("", "[graph.weights]", 'Hand = "x"'),
        4,
        "weights must be a table of joint = number, none below 0, found {'Hand': 'x'}",
    ),
    (graph("weights = 3"), 3, "weights must be a table of joint = number, none below 0, found 3"),
    (graph('motions = "some"'), 3, "motions must be one of all, tagged, found 'some'"),
    (
        graph('motions = "tagged"'),
        1,
        "the graph `Full-Body` has no motion; give it clips under [tags.Full-Body]",
    ),
    ("\n[tags.Full-Body]", 2, "the graph `Full-Body` has no motion; give it clips under [tags.Full-Body]"),
    ("tags = 3", 1, "tags must be a table, found 3"),
    ("[tags]\nFull-Body = 3", 2, "[tags.Full-Body] must be a table of motion = [tags]"),
    (
        '[tags]\nWalk_01 = ["WALK"]',
        2,
        "`Walk_01` is a clip; tags stand under the graph that they are for, as in [tags.Full-Body]",
    ),
    ('\n[tags.Full-Bdy]\nWalk_01 = ["WALK"]', 2, "[tags.Full-Bdy] names no graph; did you mean `Full-Body`?"),
    ('[tags.Full-Body]\nWalk_1 = ["WALK"]', 2, "there is no clip `Walk_1`; did you mean `Walk_01`?"),
    ('[tags.Full-Body]\nZzz = ["WALK"]', 2, "there is no clip `Zzz`"),
    ('[tags.Full-Body]\nWalk_01 = "WALK"', 2, 'Walk_01 must be a list of texts, as in ["WALK"], found a text alone'),
    ('[tags.Full-Body]\nWalk_01 = [""]', 2, "a tag must not be empty"),
    ('[tags.Full-Body]\nWalk_01 = ["A\\nB"]', 2, "a tag must stand on one line, found 'A\\nB'"),
    (
        '[tags.Full-Body]\nWalk_01 = ["Idle_01"]',
        2,
        "the tag `Idle_01` is spelt like a clip; a name can mean one thing only",
    ),
    (
        '[tags.Full-Body]\nWalk_01 = ["Full-Body"]',
        2,
        "the tag `Full-Body` is spelt like a graph; a name can mean one thing only",
    ),
    (
        '[clips.Full-Body]\nfile = "Walk_01.bvh"',
        1,
        "`Full-Body` is a clip and a graph; a name can mean one thing only",
    ),
    ("groups = 3", 1, "groups must be a table, found 3"),
    ('[groups]\nmoving = "Walk_01"', 2, 'moving must be a list of texts, as in ["Walk_01"], found a text alone'),
    (
        '[groups]\na = ["b"]\nb = ["Idle_01", "a"]\n' + rules('forbid = [["a", "a"]]'),
        2,
        "the group `a` is a member of itself",
    ),
    ("[transitions]\nforbid = []", 1, "rules for transitions are written as [[transitions]] tables"),
    (
        rules("forbidden = []"),
        2,
        "unknown key `forbidden`; expected one of graph, forbid, allow; did you mean `forbid`?",
    ),
    (rules('graph = "Full"'), 2, "graph must be one of Full-Body, found 'Full'"),
    (
        rules('forbid = ["Walk_01", "Walk_02"]'),
        2,
        "forbid must be a list of [from, to] pairs, found ['Walk_01', 'Walk_02']",
    ),
    (rules("allow = 3"), 2, "allow must be a list of [from, to] pairs, found 3"),
    (
        rules('forbid = [["Walk_01", "Walk_2"]]'),
        2,
        "`Walk_2` is no motion or tag of `Full-Body` and no group; did you mean `Walk_02`?",
    ),
    (
        '[groups]\ngo = ["Walk_01", "Wlk_02"]\n' + rules('allow = [["go", "Idle_01"]]'),
        2,
        "the group `go` names `Wlk_02`, which is no motion, tag or group; did you mean `Walk_02`?",
    ),
    (
        '[groups]\ngo = ["run"]\n[tags.Full-Body]\nWalk_01 = ["WALK", "RUN"]',
        2,
        "the group `go` names `run`, which is no motion, tag or group; did you mean `RUN`?",
    ),
    (
        '[groups]\nwalks = ["Walk_01"]\nall = ["Idle_01", "walk"]',
        3,
        "the group `all` names `walk`, which is no motion, tag or group; did you mean `walks`?",
    ),
    ('[groups]\na = ["Idle_01"]\nb = ["c"]\nc = ["a", "b"]', 3, "the group `b` is a member of itself"),
    (
        '[groups]\nWalk_01 = ["Idle_01"]',
        2,
        "the group `Walk_01` is spelt like a motion; a name can mean one thing only",
    ),
    (
        '[groups]\nWALK = ["Idle_01"]\n[tags.Full-Body]\nIdle_01 = ["WALK"]',
        2,
        "the group `WALK` is spelt like a tag; a name can mean one thing only",
    ),
]


def test_a_library_is_said_to_be_built_already(folder: Path) -> None:
    with pytest.raises(ConfigurationError) as caught:
        read(folder, b"SQLite format 3\0\xff\xfe")
    assert str(caught.value).startswith(f"{folder}/library.toml: a library that has been built already")


@pytest.mark.parametrize(("text", "line", "message"), MISTAKES)
def test_each_mistake_is_told_in_one_message_with_file_and_line(
    folder: Path, text: str | bytes, line: int, message: str
) -> None:
    with pytest.raises(ConfigurationError) as caught:
        read(folder, text)
    assert str(caught.value) == f"{folder}/library.toml:{line}: {message.replace('DIR', str(folder))}"


def test_a_metric_that_is_not_known_is_told_with_those_that_are(folder: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"library.toml:3: metric must be one of .*point-cloud.*, found 'x'"):
        read(folder, graph('metric = "x"'))


def test_a_configuration_that_is_missing_is_the_operating_systems_to_tell(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"library\.toml"):
        read_configuration(tmp_path / "library.toml")


def test_nothing_but_the_clips_must_be_written(folder: Path) -> None:
    found = read(folder, "")
    assert [clip.name for clip in found.clips] == ["Idle_01", "Walk_01", "Walk_02"]
    assert (found.frame_rate, found.up, found.start) == (None, "y", None)
    (only,) = found.graphs
    assert (only.name, only.joints, only.without) == ("Full-Body", None, ())
    assert (only.window, only.threshold, only.metric, only.blend) == (20, Threshold("auto"), "point-cloud", "c1")
    assert (only.weights, only.forbidden) == ({}, frozenset())
    assert only.motions == {"Idle_01": (), "Walk_01": (), "Walk_02": ()}


def test_everything_that_can_be_written_is_read(folder: Path) -> None:
    text = """\
        [library]
        clips = ["Walk_0?.bvh"]
        frame_rate = 60
        up = "z"
        start = "Sit"

        [clips.Sit]
        file = "sub/Walk_01.bvh"
        frames = [10, 900]
        mirror = true

        [[graph]]
        name = "Full-Body"
        threshold = { quantile = 0.01 }
        weights = { Hand_L = 2 }

        [[graph]]
        name = "Upper-Body"
        joints = ["Spine"]
        without = ["Hand_L"]
        window = 12
        threshold = 250.5
        metric = "point-cloud"
        blend = "linear"

        [tags.Upper-Body]
        Walk_02 = ["SWING", "FAST"]
        Sit = []
        """
    found = read(folder, text)
    walks = [(clip.name, clip.path, clip.frames, clip.mirror) for clip in found.clips]
    assert walks == [
        ("Walk_01", folder / "Walk_01.bvh", None, False),
        ("Walk_02", folder / "Walk_02.bvh", None, False),
        ("Sit", folder / "sub/Walk_01.bvh", (10, 900), True),
    ]
    assert (found.frame_rate, found.up, found.start) == (60.0, "z", "Sit")
    whole, upper = found.graphs
    assert (whole.threshold, whole.weights) == (Threshold("quantile", 0.01), {"Hand_L": 2.0})
    assert (upper.joints, upper.without, upper.window) == (("Spine",), ("Hand_L",), 12)
    assert (upper.threshold, upper.blend) == (Threshold("number", 250.5), "linear")
    assert list(upper.motions.items()) == [("Walk_02", ("SWING", "FAST")), ("Sit", ())]


def test_a_clip_made_of_another_leaves_that_one_where_it_is(folder: Path) -> None:
    found = read(folder, '[library]\nclips = ["*.bvh"]\n[clips.Stroll]\nfile = "Walk_01.bvh"\nmirror = true')
    assert [clip.name for clip in found.clips] == ["Idle_01", "Walk_01", "Walk_02", "Stroll"]


def test_a_clip_on_no_graph_is_left_out(folder: Path) -> None:
    found = read(folder, "[tags.Full-Body]\nWalk_02 = []\nIdle_01 = []")
    assert [clip.name for clip in found.clips] == ["Idle_01", "Walk_02"]
    assert found.left_out == ("Walk_01",)


def test_motions_are_in_the_order_of_their_tags(folder: Path) -> None:
    found = read(folder, "[tags.Full-Body]\nWalk_02 = []\nIdle_01 = []")
    assert list(found.graphs[0].motions) == ["Walk_02", "Idle_01"]


def test_a_graph_of_all_motions_has_those_without_an_entry_last(folder: Path) -> None:
    found = read(folder, graph('motions = "all"', "[tags.Full-Body]", 'Walk_02 = ["WALK"]'))
    assert list(found.graphs[0].motions.items()) == [("Walk_02", ("WALK",)), ("Idle_01", ()), ("Walk_01", ())]


def test_names_are_compared_as_they_look(folder: Path) -> None:
    composed, decomposed = "Caf\u00e9", "Cafe\u0301"
    text = f'[clips.{composed!r}]\nfile = "Walk_01.bvh"\n[tags.Full-Body]\n{decomposed!r} = ["{decomposed}"]'
    with pytest.raises(ConfigurationError, match=f"the tag `{composed}` is spelt like a clip"):
        read(folder, text)


def test_a_start_is_on_the_graph_of_the_whole_body_wherever_that_stands(folder: Path) -> None:
    graphs = '[[graph]]\nname = "Upper"\njoints = ["Spine"]\n[[graph]]\nname = "Whole"\n[tags.Upper]\nWalk_01 = []\n'
    found = read(folder, graphs + '[library]\nstart = "Idle_01"')
    check_start(found, found.graphs[1])
    with pytest.raises(ConfigurationError) as caught:
        check_start(found, found.graphs[0])
    assert str(caught.value) == f"{folder}/library.toml:9: start `Idle_01` is not a motion of `Upper`"


TAGGED = """\
[tags.Full-Body]
Idle_01 = ["STILL"]
Walk_01 = ["WALK"]
Walk_02 = ["WALK"]
[groups]
moving = ["WALK"]
all = ["moving", "Idle_01"]
"""


@pytest.mark.parametrize(
    ("rule", "forbidden"),
    [
        ('forbid = [["Idle_01", "Walk_02"]]', {("Idle_01", "Walk_02")}),
        ('forbid = [["WALK", "STILL"]]', {("Walk_01", "Idle_01"), ("Walk_02", "Idle_01")}),
        ('forbid = [["moving", "Walk_01"]]', {("Walk_01", "Walk_01"), ("Walk_02", "Walk_01")}),
        ('forbid = [["Idle_01", "all"]]', {("Idle_01", m) for m in ("Idle_01", "Walk_01", "Walk_02")}),
        (
            'allow = [["WALK", "WALK"], ["Idle_01", "Walk_01"]]',
            {("Idle_01", "Walk_02"), ("Walk_01", "Idle_01"), ("Walk_02", "Idle_01")},
        ),
    ],
)
def test_pairs_of_motions_are_forbidden_by_motion_tag_and_group(
    folder: Path, rule: str, forbidden: set[tuple[str, str]]
) -> None:
    assert read(folder, TAGGED + rules(rule)).graphs[0].forbidden == forbidden


def test_rules_for_transitions_hold_for_their_graph_alone(folder: Path) -> None:
    second = '[[graph]]\nname = "Upper"\njoints = ["Spine"]\n[[graph]]\nname = "Whole"\n'
    first, whole = read(folder, second + rules('graph = "Upper"', 'forbid = [["Idle_01", "Walk_01"]]')).graphs
    assert (len(first.forbidden), len(whole.forbidden)) == (1, 0)
    first, whole = read(folder, second + rules('forbid = [["Idle_01", "Walk_01"]]')).graphs
    assert (len(first.forbidden), len(whole.forbidden)) == (0, 1)
