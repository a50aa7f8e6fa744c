from mlmg_runtime.view.captions import story_from_report
from mlmg_runtime.view.palette import accent
from mlmg_runtime.view.scene import scene_from_bvh
from mlmg_runtime.view.tints import tints_at


def test_a_part_is_coloured_while_its_graph_runs(scene):
    joints = {scene.joint_names.index("chest"), scene.joint_names.index("left arm")}
    assert tints_at(scene, 29) == {}
    assert tints_at(scene, 45) == dict.fromkeys(joints, accent(1))
    assert tints_at(scene, 58) == {}


def test_the_root_graph_colours_nothing(person, report):
    story = story_from_report({**report, "joints": {"Full-Body": ["spine"]}})
    assert tints_at(scene_from_bvh(person(), "x", story=story), 5) == {}


def test_accents_begin_anew_when_they_are_used_up():
    assert accent(0) == accent(6) != accent(1)
