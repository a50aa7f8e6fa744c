import json

import pytest

from mlmg_runtime.view.captions import ReportError, is_report, read_story, story_from_report


@pytest.fixture
def story(report):
    return story_from_report(report)


@pytest.mark.parametrize(
    ("frame", "text"),
    [(0, "WALK for 1 sec"), (29, "WALK for 1 sec"), (30, "Sub TALK </script>"), (59, "Sub TALK </script>")],
)
def test_the_command_is_the_last_that_has_begun(story, frame, text):
    assert story.command_at(frame).text == text


@pytest.mark.parametrize(
    ("frame", "expected"),
    [
        (0, {"Full-Body": "Idle_01"}),
        (10, {"Full-Body": "Idle_01 → Walk_01"}),
        (20, {"Full-Body": "Walk_01 ×1.1"}),
        (35, {"Full-Body": "Walk_01 ×1.1", "Upper-Body": "Walk_01 → Talk_01"}),
        (49, {"Full-Body": "Walk_01 ×1.1", "Upper-Body": "Talk_01"}),
        (50, {"Full-Body": "Walk_01 ×1.1", "Upper-Body": "Talk_01 ↺"}),
        (55, {"Full-Body": "Walk_01 ×1.1", "Upper-Body": "Talk_01 → parent"}),
        (57, {"Full-Body": "Walk_01 ×1.1", "Upper-Body": "blend"}),
        (58, {"Full-Body": "Walk_01 ×1.1"}),
    ],
)
def test_each_graph_that_runs_says_what_it_plays(story, frame, expected):
    assert {graph: stretch.text for graph, stretch in story.playing_at(frame)} == expected


def test_a_part_of_a_story_is_told_in_frames_of_its_own(story):
    part = story.within(range(25, 45))
    assert [(one.begin, one.arrive, one.end) for one in part.commands] == [(0, 0, 5), (5, 15, 20)]
    full, upper = part.tracks
    assert [(one.begin, one.end, one.text) for one in full.stretches] == [(0, 20, "Walk_01 ×1.1")]
    assert [(one.begin, one.end) for one in upper.stretches] == [(5, 15), (15, 20)]
    assert part.joints == story.joints


@pytest.mark.parametrize("frames", [range(60), range(25, 45), range(0, 60, 7), range(3, 58, 4)])
def test_a_part_of_a_story_says_of_each_frame_what_the_whole_does(story, frames):
    part = story.within(frames)
    for at, frame in enumerate(frames):
        assert part.command_at(at).text == story.command_at(frame).text
        playing = [
            [(graph, one.text) for graph, one in told] for told in (part.playing_at(at), story.playing_at(frame))
        ]
        assert playing[0] == playing[1]


def test_a_command_that_takes_no_time_is_told_where_it_stands(story):
    assert [one.text for one in story.within(range(0, 5)).commands] == ["Idle_01", "WALK for 1 sec"]
    assert [one.text for one in story.within(range(1, 5)).commands] == ["WALK for 1 sec"]


def test_a_report_without_joints_names_none(report):
    assert story_from_report({**report, "joints": {}}).joints == ()
    assert story_from_report({key: report[key] for key in report if key != "joints"}).joints == ()


def test_a_report_is_told_from_other_json(report):
    assert is_report(report)
    assert not any(map(is_report, ([], "report", {"name": "package"}, None)))


def test_a_report_is_read_from_a_file(tmp_path, report, story):
    (tmp_path / "r.json").write_text(json.dumps(report), encoding="utf-8")
    assert read_story(tmp_path / "r.json", 60) == story


def test_the_report_of_another_motion_is_refused(tmp_path, report):
    (tmp_path / "r.json").write_text(json.dumps(report), encoding="utf-8")
    with pytest.raises(ReportError, match=r"r\.json: expected the report of a motion of 59 frames, found one of 60"):
        read_story(tmp_path / "r.json", 59)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", r"r\.json:1: expected the report of a run as JSON, found "),
        ("[1, 2]", r'expected the report of a run, with "n_frames", "commands" and "tracks"'),
        ('{"n_frames": 60, "commands": [{"text": "x"}], "tracks": {}}', "cannot be understood: no key 'begin'"),
        ('{"n_frames": 60, "commands": [], "tracks": [1]}', "cannot be understood: "),
    ],
)
def test_what_is_wrong_with_a_report_is_said(tmp_path, content, message):
    (tmp_path / "r.json").write_text(content, encoding="utf-8")
    with pytest.raises(ReportError, match=message):
        read_story(tmp_path / "r.json", 60)


def test_a_file_that_is_no_text_is_no_report(tmp_path):
    (tmp_path / "r.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ReportError, match="expected the report of a run as JSON"):
        read_story(tmp_path / "r.json", 60)
