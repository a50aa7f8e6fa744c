from collections.abc import Callable

import pytest

from mlmg_runtime.bvh import Bvh, Joint, read_bytes
from mlmg_runtime.errors import BvhError

HIPS = ("Xposition", "Yposition", "Zposition", "Zrotation", "Xrotation", "Yrotation")
SPINE = ("Zrotation", "Xrotation", "Yrotation")
END_SITE = "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 1 0\n\t\t}\n"
Changed = Callable[[str, str], Bvh]


def test_joints_are_as_the_file_says_them(text: str) -> None:
    assert read_bytes(text.encode(), "clip.bvh").joints == (
        Joint("Hips", -1, (0.0, 0.0, 0.0), HIPS),
        Joint("Spine", 0, (0.0, 5.0, 0.0), SPINE, (0.0, 1.0, 0.0)),
    )


def test_siblings_and_nephews_have_the_parents_that_the_braces_say(changed: Changed) -> None:
    more = "}\n\tJOINT Leg\n{ OFFSET 1 2 3\nCHANNELS 0\nJOINT Foot {\nOFFSET 1 2 3\nCHANNELS 0 } }\n}\nMOTION"
    joints = changed("}\nMOTION", more.replace("}\n", "", 1)).joints
    assert [(joint.name, joint.parent) for joint in joints] == [
        ("Hips", -1),
        ("Spine", 0),
        ("Leg", 0),
        ("Foot", 2),
    ]


@pytest.mark.parametrize("name", ["left.arm", "Left Arm 2", "mixamorig:Spine", "a  b", "走", "JOINT", "End", "MOTION"])
def test_a_name_is_the_rest_of_its_line(name: str, changed: Changed) -> None:
    assert changed("Spine", name).joints[1].name == name


@pytest.mark.parametrize(
    "channels",
    [
        "6 Yrotation Xrotation Zrotation Zposition Yposition Xposition",
        "6 Xposition Yrotation Zposition Xrotation Yposition Zrotation",
    ],
)
def test_the_root_may_have_its_channels_in_any_order(channels: str, changed: Changed) -> None:
    old = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    assert changed(old, channels).joints[0].channels == tuple(channels.split()[1:])


def test_any_joint_may_have_positions_or_few_channels_or_none(changed: Changed) -> None:
    line = "CHANNELS 3 Zrotation Xrotation Yrotation"
    with_positions = changed(line, "CHANNELS 3 Zposition Xrotation Yposition")
    assert with_positions.joints[1].channels == ("Zposition", "Xrotation", "Yposition")
    few = line + "\nJOINT Jaw\n{\nOFFSET 1 2 3\nCHANNELS 0\n}"
    assert changed(line, few).joints[2].channels == ()


def test_a_leaf_without_an_end_site_is_a_leaf(changed: Changed) -> None:
    assert changed(END_SITE, "").joints[1].end_site is None


def test_a_second_end_site_is_left_out_with_a_warning(changed: Changed) -> None:
    bvh = changed(END_SITE, END_SITE + END_SITE.replace("1", "7"))
    assert bvh.joints[1].end_site == (0.0, 1.0, 0.0)
    assert bvh.warnings == ("line 14: a second End Site in joint `Spine` is left out",)


@pytest.mark.parametrize("change", [str.lower, str.upper, lambda text: text.replace("\n\t{", " {")])
def test_case_and_the_place_of_braces_do_not_matter(change: Callable[[str], str], text: str) -> None:
    joints = read_bytes(change(text).encode(), "clip.bvh").joints
    assert [(joint.name.title(), joint.channels) for joint in joints] == [("Hips", HIPS), ("Spine", SPINE)]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("HIERARCHY\n", "HIERARCHY\n\n", ""),
        ("HIERARCHY\n", "HIERARCHY 2\n", "1: expected HIERARCHY, found `HIERARCHY 2`"),
        ("ROOT", "JOINT", "2: expected ROOT and a name, found `JOINT Hips`"),
        ("ROOT Hips", "ROOT", "2: expected the name of the joint, found none"),
        ("JOINT Spine", "JOINT  ", "6: expected the name of the joint, found none"),
        ("Spine", "Hips", "6: expected a new joint name, found `Hips`, as in line 2"),
        ("JOINT", "JONIT", "6: expected JOINT, End Site or } in joint `Hips`, found `JONIT Spine`"),
        ("JOINT", "ROOT", "6: expected JOINT, End Site or } in joint `Hips`, found `ROOT Spine`"),
        ("Spine\n\t{", "Spine\n\t", "8: expected {, found `OFFSET 0 5 0`"),
        ("\tOFFSET 0 5 0\n", "", "6: expected OFFSET in joint `Spine`, found none"),
        ("OFFSET 0 5 0", "OFFSET 0 5", "8: expected 3 numbers after OFFSET, found 2"),
        ("OFFSET 0 5 0", "OFFSET 0 5 0 0", "8: expected 3 numbers after OFFSET, found 4"),
        ("OFFSET 0 5 0", "OFFSET 0 5,0 0", "8: expected a number after OFFSET, found `5,0`"),
        ("OFFSET 0 5 0", "OFFSET 0 nan 0", "8: expected a number after OFFSET, found `nan`"),
        (
            "OFFSET 0 5 0",
            "OFFSET 0 5 0\nOFFSET 0 5 0",
            "9: expected CHANNELS, JOINT, End Site or } in joint `Spine`, found `OFFSET 0 5 0`",
        ),
        (
            "\tCHANNELS 3 Zrotation Xrotation Yrotation\n",
            "",
            "6: expected CHANNELS in joint `Spine`, found none",
        ),
        ("CHANNELS 3", "CHANNELS 2", "9: expected 2 channel names, found 3"),
        ("CHANNELS 3", "CHANNELS", "9: expected the number of channels, found `Zrotation`"),
        ("3 Zrotation Xrotation Yrotation", "", "9: expected the number of channels, found nothing"),
        (
            "3 Zrotation",
            "3 Xrotation",
            "9: expected each channel once, found `Xrotation Xrotation Yrotation`",
        ),
        ("3 Zrotation", "3 Zscale", "9: expected a channel such as Xposition or Zrotation, found `Zscale`"),
        ("\t\t\tOFFSET 0 1 0\n", "", "12: expected OFFSET in the End Site, found `}`"),
        ("OFFSET 0 1 0", "OFFSET 0 1 0\nCHANNELS 0", "13: expected }, found `CHANNELS 0`"),
        ("End Site\n\t\t{", "End Site", "11: expected {, found `OFFSET 0 1 0`"),
        ("}\nMOTION", "MOTION", "15: expected JOINT, End Site or } in joint `Hips`, found `MOTION`"),
        ("MOTION", "}\nMOTION", "16: expected MOTION after the one skeleton of the file, found `}`"),
        ("MOTION", "ROOT b", "16: expected MOTION after the one skeleton of the file, found `ROOT b`"),
    ],
)
def test_of_a_wrong_hierarchy_the_error_says_where_and_what(old: str, new: str, message: str, changed: Changed) -> None:
    if not message:
        changed(old, new)
        return
    with pytest.raises(BvhError) as caught:
        changed(old, new)
    assert str(caught.value) == f"clip.bvh:{message}"


def test_a_hierarchy_may_be_a_thousand_joints_deep(text: str) -> None:
    head, rest = text.split("MOTION")
    joint = "JOINT {}\n{{\nOFFSET 0 1 0\nCHANNELS 0\n"
    deep = "".join(joint.format(f"j{at}") for at in range(2000)) + "}" * 2000 + "\n}\n"
    bvh = read_bytes((head.rstrip()[:-1] + deep + "MOTION" + rest).encode(), "clip.bvh")
    assert bvh.joints[-1].parent == len(bvh.joints) - 2 == 2000
