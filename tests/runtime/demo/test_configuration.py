import tomllib

import pytest

from mlmg_runtime.demo.clips import demo_clips
from mlmg_runtime.demo.configuration import demo_configuration
from mlmg_runtime.demo.skeleton import human_skeleton

FULL_BODY = {
    "Idle_01": ["IDLE"],
    "Idle_02": ["IDLE"],
    "Walk_01": ["WALK"],
    "Walk_02": ["WALK"],
    "Walk_03": ["WALK", "WAVE_HAND"],
    "Music_01": ["Music", "IDLE"],
    "Talk_01": ["TALK", "IDLE"],
    "Talk_02": ["TALK"],
}
UPPER_BODY = {
    "Idle_01": ["IDLE"],
    "Walk_01": ["SWING_HAND"],
    "Walk_02": ["SWING_HAND"],
    "Walk_03": ["WAVE_HAND"],
    "Music_01": ["Music", "IDLE"],
    "Talk_01": ["TALK", "IDLE"],
    "Talk_02": ["TALK"],
}
LEFT_HAND = {**UPPER_BODY, "Wave_01": ["WAVE"]}


@pytest.fixture(scope="module")
def configuration() -> dict:
    return tomllib.loads(demo_configuration())


def test_the_motions_and_tags_are_those_of_the_language_reference(configuration: dict) -> None:
    assert configuration["tags"] == {"Full-Body": FULL_BODY, "Upper-Body": UPPER_BODY, "Left-Hand": LEFT_HAND}
    assert all(list(configuration["tags"][graph]) == list(tags) for graph, tags in [("Full-Body", FULL_BODY)])


def test_every_clip_is_on_a_graph_and_every_motion_has_a_clip(configuration: dict) -> None:
    assert {motion for tags in configuration["tags"].values() for motion in tags} == set(demo_clips())


def test_the_graphs_are_one_below_the_other(configuration: dict) -> None:
    skeleton = human_skeleton()
    below = set(skeleton.names)
    for graph, name in zip(configuration["graph"], ("Full-Body", "Upper-Body", "Left-Hand"), strict=True):
        assert graph["name"] == name
        joints = {
            skeleton.names[joint]
            for root in graph.get("joints", ["Hips"])
            for joint in skeleton.subtree(skeleton.names.index(root))
        }
        assert joints <= below
        below = joints
    assert "LeftHandIndex" in below


def test_the_library_begins_with_the_first_idle_at_30_frames_a_second(configuration: dict) -> None:
    library = configuration["library"]
    assert (library["start"], library["frame_rate"], library["up"]) == ("Idle_01", 30, "y")
    assert library["clips"] == ["*.bvh"]
