from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from mlmg_runtime.building.build import SMOOTH_SHARE, build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.built_library import BuiltLibrary
from mlmg_runtime.database import write_database
from mlmg_runtime.errors import ConfigurationError
from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph, Transition
from mlmg_runtime.point_cloud import point_cloud, window_distances
from mlmg_runtime.skeleton import world_positions

# A transition of the naive build: source motion and frame, target motion and frame, distance.
Edge = tuple[int, int, int, int, float]

ONE_GRAPH = """\
[[graph]]
name = "Full-Body"
window = 8
threshold = THRESHOLD
"""
# Little enough for slow versions to look at every pair of windows.
FEW_CLIPS = """\
[clips.Stand]
frames = [0, 70]
[clips.Sway]
frames = [5, 75]
[clips.Stroll]
frames = [0, 60]
"""


def build(folder: Path, text: str, **options) -> BuiltLibrary:
    (folder / "library.toml").write_text(text, encoding="utf-8")
    configuration = read_configuration(folder / "library.toml")
    return build_library(configuration, options.get("executor"), options.get("progress", lambda *_: None))


def distances_of(built: BuiltLibrary, graph: MotionGraph, a: int, b: int) -> np.ndarray:
    clouds = []
    for motion in (a, b):
        points = world_positions(built.skeleton, built.poses[graph.motions[motion]])
        clouds.append(point_cloud(points[:, list(graph.joints)], graph.weights, graph.window))
    return window_distances(*clouds)


def naive_edges(built: BuiltLibrary, graph: MotionGraph) -> Iterator[Edge]:
    """Yield both transitions of every local minimum of every pair of motions, found by looking at each entry."""
    k = graph.window
    for a in range(len(graph.motions)):
        for b in range(a, len(graph.motions)):
            distances = distances_of(built, graph, a, b)
            rows, columns = distances.shape
            for i in range(rows):
                for s in range(columns):
                    near = distances[max(i - 1, 0) : i + 2, max(s - 1, 0) : s + 2]
                    if distances[i, s] == near.min() and (a != b or s - i >= k):
                        yield a, i, b, s + k - 1, distances[i, s]
                        yield b, s, a, i + k - 1, distances[i, s]


def naive_cleaned(graph: MotionGraph, edges: list[Edge]) -> list[Edge]:
    """Return the transitions inside the largest set of positions that can reach each other."""
    onward = {(m, f): set() for m, n in enumerate(graph.n_frames.tolist()) for f in range(n)}
    for motion, frame in onward:
        onward[motion, frame] |= {(motion, frame + 1)} & onward.keys()
    for a, i, b, j, _ in edges:
        onward[a, i] |= {(b, j + 1)} & onward.keys()
    reach = {}
    for start in onward:
        reach[start], pending = {start}, [start]
        while pending:
            new = onward[pending.pop()] - reach[start]
            reach[start] |= new
            pending += new
    component = max(({b for b in reach[a] if a in reach[b]} for a in onward), key=len)
    return [edge for edge in edges if {edge[:2], (edge[2], edge[3] + 1)} <= component]


def as_edges(graph: MotionGraph) -> list[Edge]:
    return [tuple(edge[:5]) for edge in graph.edges]


def check_edges(graph: MotionGraph, expected: list[Edge]) -> None:
    assert [edge[:4] for edge in as_edges(graph)] == sorted(edge[:4] for edge in expected)
    np.testing.assert_allclose(graph.transitions["distance"], [edge[4] for edge in sorted(expected)], rtol=1e-9)


@pytest.mark.parametrize("threshold", [700.0, 2000.0])
def test_below_a_number_all_candidates_that_lie_on_endless_walks_are_transitions_both_ways(
    small_folder: Path, threshold: float
) -> None:
    built = build(small_folder, ONE_GRAPH.replace("THRESHOLD", str(threshold)) + FEW_CLIPS)
    (graph,) = built.graphs
    assert graph.sigma == threshold
    candidates = list(naive_edges(built, graph))
    expected = naive_cleaned(graph, [edge for edge in candidates if edge[4] <= threshold])
    assert expected
    check_edges(graph, expected)
    assert built.reports[0].n_candidates == len(candidates) / 2
    assert built.reports[0].n_transitions == len(expected)


def test_a_quantile_is_the_distance_below_which_that_share_of_window_pairs_lies(small_folder: Path) -> None:
    built = build(small_folder, ONE_GRAPH.replace("THRESHOLD", "{ quantile = 0.05 }") + FEW_CLIPS)
    (graph,) = built.graphs
    everything = []
    for a in range(len(graph.motions)):
        for b in range(a, len(graph.motions)):
            distances = distances_of(built, graph, a, b)
            everything.append(distances.ravel() if a != b else distances[np.triu_indices(len(distances), graph.window)])
    assert np.mean(np.concatenate(everything) <= graph.sigma) == pytest.approx(0.05, abs=1e-3)
    expected = [edge for edge in naive_edges(built, graph) if edge[4] <= graph.sigma]
    check_edges(graph, naive_cleaned(graph, expected))


def test_auto_takes_smooth_transitions_and_bridges_the_motions_that_these_do_not_join(small_folder: Path) -> None:
    built = build(small_folder, ONE_GRAPH.replace("THRESHOLD", '"auto"') + FEW_CLIPS)
    (graph,), (report,) = built.graphs, built.reports
    candidates = list(naive_edges(built, graph))
    smooth = naive_cleaned(graph, [edge for edge in candidates if edge[4] <= graph.sigma])
    assert {edge[:4] for edge in smooth} <= {edge[:4] for edge in as_edges(graph)}
    assert {edge[:4] for edge in as_edges(graph)} <= {edge[:4] for edge in candidates}
    assert len({edge[0] for edge in smooth}) < len(graph.motions)
    assert not (graph.hops == UNREACHABLE).any()
    dear = [edge for edge in graph.edges if edge.distance > graph.sigma]
    assert len(report.bridges) == len(dear) > 0
    n_points = graph.window * graph.weights.sum()
    for (source, target, distance), edge in zip(report.bridges, dear, strict=True):
        assert (source, target) == (graph.motions[edge.src_motion], graph.motions[edge.dst_motion])
        assert distance == pytest.approx(np.sqrt(edge.distance / n_points))
        assert distance > report.threshold == pytest.approx(np.sqrt(graph.sigma / n_points))


def test_smooth_is_a_share_of_how_tall_the_body_stands(small_folder: Path) -> None:
    text = ONE_GRAPH.replace("THRESHOLD", '"auto"')
    tall = build(small_folder, text).reports[0].threshold
    heights = [
        np.ptp(world_positions(built.skeleton, poses)[..., 1], axis=1)
        for built in [build(small_folder, text)]
        for poses in built.poses.values()
    ]
    assert tall == pytest.approx(SMOOTH_SHARE * np.median(np.concatenate(heights)))


def test_costs_grow_from_none_at_no_distance_to_two_thirds_at_the_threshold(small_library) -> None:
    for graph in small_library.by_name.values():
        expected = 1.0 - np.exp(-graph.transitions["distance"] / graph.sigma)
        np.testing.assert_allclose(graph.transitions["cost"], expected, rtol=1e-12)
        assert graph.transitions["cost"].min() >= 0.0
        assert graph.transitions["cost"].max() < 1.0


def test_transitions_are_sorted_and_leave_and_arrive_inside_clips(small_library) -> None:
    for graph in small_library.by_name.values():
        places = [edge[:4] for edge in graph.edges]
        assert places == sorted(set(places))
        for edge in graph.edges:
            assert 0 <= edge.src_frame <= graph.n_frames[edge.src_motion] - graph.window
            assert graph.window - 1 <= edge.dst_frame < graph.n_frames[edge.dst_motion] - 1
            if edge.src_motion == edge.dst_motion:
                assert abs(edge.dst_frame - graph.window + 1 - edge.src_frame) >= graph.window


def test_no_endless_walk_gets_stuck(small_library) -> None:
    """Follow every transition by the first that leaves after its arrival, until all that follows was seen before."""
    for graph in small_library.by_name.values():
        for edge in graph.edges:
            assert any(
                onward.src_motion == edge.dst_motion and onward.src_frame > edge.dst_frame for onward in graph.edges
            )


def test_the_motion_table_tells_the_fewest_transitions_between_motions(small_library) -> None:
    for graph in small_library.by_name.values():
        direct = {(edge.src_motion, edge.dst_motion) for edge in graph.edges}
        for source in range(len(graph.motions)):
            reached, n_hops, found = {source}, 0, {source: 0}
            while reached:
                n_hops += 1
                reached = {b for a, b in direct if a in reached} - found.keys()
                found |= dict.fromkeys(reached, n_hops)
            for target, hops in enumerate(graph.hops[source].tolist()):
                assert hops == found.get(target, UNREACHABLE)


def test_lost_frames_are_those_that_no_endless_walk_passes(small_library) -> None:
    """Count, in each motion, the frames between the first arrival and the last departure as those that are passed."""
    for graph in small_library.by_name.values():
        lost = small_library.reports[graph.name]["lost_frames"]
        for index, motion in enumerate(graph.motions):
            arrivals = [edge.dst_frame + 1 for edge in graph.edges if edge.dst_motion == index]
            departures = [edge.src_frame for edge in graph.edges if edge.src_motion == index]
            passed = set(range(min(arrivals), max(departures) + 1))
            could_be = range(graph.window, int(graph.n_frames[index]) - graph.window + 1)
            assert lost.get(motion, 0) == len([frame for frame in could_be if frame not in passed])


def test_the_similarity_of_each_pair_of_motions_comes_from_their_distances(small_folder: Path) -> None:
    built = build(small_folder, ONE_GRAPH.replace("THRESHOLD", '"auto"'))
    (graph,) = built.graphs
    for a in range(len(graph.motions)):
        for b in range(len(graph.motions)):
            distances = distances_of(built, graph, a, b)
            rows, columns = (range(0, size, 20) for size in distances.shape)
            blocks = [distances[i : i + 20, j : j + 20].min() for i in rows for j in columns]
            assert graph.oms[a, b] == pytest.approx(sum(blocks) / len(blocks))


def test_forbidden_transitions_are_not_there_and_others_are(small_folder: Path) -> None:
    text = ONE_GRAPH.replace("THRESHOLD", "2000.0") + '[tags.Full-Body]\nStand=["IDLE"]\nSway=["IDLE"]\nStroll=[]\n'
    rule = '[[transitions]]\nforbid = [["IDLE", "moving"], ["Sway", "Sway"]]\n[groups]\nmoving = ["Stroll"]\n'

    def pairs(built: BuiltLibrary) -> Counter[tuple[str, str]]:
        (graph,) = built.graphs
        return Counter((graph.motions[e.src_motion], graph.motions[e.dst_motion]) for e in graph.edges)

    everything, rest = pairs(build(small_folder, text)), pairs(build(small_folder, text + rule))
    forbidden = {("Stand", "Stroll"), ("Sway", "Stroll"), ("Sway", "Sway")}
    assert all(everything[pair] for pair in forbidden)
    assert not any(rest[pair] for pair in forbidden)
    assert rest["Stand", "Sway"] == everything["Stand", "Sway"] > 0


def test_where_pairs_are_allowed_nothing_else_is_but_staying_in_a_motion(small_folder: Path) -> None:
    rule = '[[transitions]]\nallow = [["Stand", "Sway"], ["Sway", "Stand"]]\n'
    (graph,) = build(small_folder, ONE_GRAPH.replace("THRESHOLD", "2000.0") + rule).graphs
    found = {(graph.motions[edge.src_motion], graph.motions[edge.dst_motion]) for edge in graph.edges}
    assert found == {("Stand", "Sway"), ("Sway", "Stand"), ("Stand", "Stand"), ("Sway", "Sway")}


def test_motions_that_cannot_be_joined_are_told_as_lost(small_folder: Path) -> None:
    rule = '[[transitions]]\nforbid = [["others", "Wave"]]\n[groups]\nothers = ["Stand", "Stroll", "Sway", "Reach"]\n'
    built = build(small_folder, ONE_GRAPH.replace("THRESHOLD", '"auto"') + rule)
    (graph,), (report,) = built.graphs, built.reports
    assert report.lost_motions == ("Wave",)
    wave = graph.index["Wave"]
    assert not any(wave in (edge.src_motion, edge.dst_motion) for edge in graph.edges)
    assert set(graph.hops[wave].tolist()) == {0, UNREACHABLE}


def test_weights_change_what_is_alike_and_stand_with_their_joints(small_folder: Path) -> None:
    text = ONE_GRAPH.replace("THRESHOLD", '"auto"')
    plain = build(small_folder, text).graphs[0]
    weighted = build(small_folder, text + "weights = { LeftHand = 4, RightLeg = 0 }\n").graphs[0]
    names = build(small_folder, text).skeleton.names
    by_joint = dict(zip([names[joint] for joint in weighted.joints], weighted.weights.tolist(), strict=True))
    assert by_joint == {name: {"LeftHand": 4.0, "RightLeg": 0.0}.get(name, 1.0) for name in names}
    assert not np.allclose(plain.oms, weighted.oms)


def test_parents_come_before_children_whatever_their_order_in_the_configuration(
    small_folder: Path, small_configuration: str
) -> None:
    parts = small_configuration.split("[[graph]]")
    last, *rest = parts[4].split("[tags", 1)
    shuffled = "[[graph]]".join([parts[0], last, parts[3], parts[2], parts[1] + "[tags" + rest[0]])
    built = build(small_folder, shuffled)
    assert [(graph.name, graph.parent) for graph in built.graphs] == [
        ("Full-Body", None),
        ("Upper-Body", "Full-Body"),
        ("Right-Arm", "Upper-Body"),
        ("Left-Arm", "Upper-Body"),
    ]
    assert built.start == "Stand"


def test_without_a_start_the_first_motion_of_the_whole_body_is_it(small_folder: Path) -> None:
    assert build(small_folder, ONE_GRAPH.replace("THRESHOLD", '"auto"')).start == "Reach"


def test_a_start_that_is_not_on_the_whole_body_is_told_with_its_line(small_folder: Path) -> None:
    text = '[library]\nstart = "Stnd"\n' + ONE_GRAPH.replace("THRESHOLD", '"auto"')
    with pytest.raises(ConfigurationError) as caught:
        build(small_folder, text)
    assert str(caught.value) == (
        f"{small_folder}/library.toml:2: start `Stnd` is not a motion of `Full-Body`; did you mean `Stand`?"
    )


def test_a_clip_shorter_than_a_window_is_lost_but_no_error(small_folder: Path) -> None:
    text = ONE_GRAPH.replace("THRESHOLD", '"auto"') + "[clips.Wave]\nframes = [3, 8]\n[library]\nclips=['*.bvh']\n"
    built = build(small_folder, text)
    assert built.reports[0].lost_motions == ("Wave",)
    assert built.reports[0].lost_frames.get("Wave") is None


@pytest.mark.parametrize("threshold", ['"auto"', "100.0", "{ quantile = 0.5 }"])
def test_a_body_that_never_moves_can_be_built(small_folder: Path, small_clips, threshold: str) -> None:
    from mlmg_runtime.bvh import Bvh, write

    for name, clip in small_clips.items():
        still = np.repeat(small_clips["Stand"].frames[:1], len(clip.frames), axis=0)
        write(Bvh(clip.joints, clip.frame_time_s, still), small_folder / f"{name}.bvh")
    (graph,) = build(small_folder, ONE_GRAPH.replace("THRESHOLD", threshold)).graphs
    assert np.isfinite(graph.transitions["cost"]).all()


def test_the_same_inputs_give_the_same_bytes_with_and_without_an_executor(
    small_folder: Path, small_configuration: str
) -> None:
    files = []
    with ThreadPoolExecutor(3) as executor:
        for number, helper in enumerate((None, None, executor)):
            write_database(build(small_folder, small_configuration, executor=helper), small_folder / f"{number}.mlmg")
            files.append((small_folder / f"{number}.mlmg").read_bytes())
    assert files[0] == files[1] == files[2]


def test_the_same_folder_elsewhere_gives_the_same_bytes(
    small_folder: Path, small_configuration: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    import shutil

    elsewhere = tmp_path_factory.mktemp("elsewhere") / "deeper"
    shutil.copytree(small_folder, elsewhere)
    files = []
    for folder in (small_folder, elsewhere):
        write_database(build(folder, small_configuration), folder / "out.mlmg")
        files.append((folder / "out.mlmg").read_bytes())
    assert files[0] == files[1]


def test_building_tells_what_it_does_and_how_far_it_is(small_folder: Path, small_configuration: str) -> None:
    told: list[tuple[str, int, int]] = []
    build(small_folder, small_configuration, progress=lambda *what: told.append(what))
    stages = dict.fromkeys(what for what, _, _ in told)
    assert list(stages) == [
        "reading clips",
        *(f"comparing the motions of {name}" for name in ("Full-Body", "Upper-Body", "Left-Arm", "Right-Arm")),
    ]
    for stage in stages:
        done = [n for what, n, _ in told if what == stage]
        (total,) = {n for what, _, n in told if what == stage}
        assert done == list(range(total + 1))


@pytest.mark.mocap
def test_the_reference_library_hangs_together_on_both_graphs(reference_built: BuiltLibrary) -> None:
    assert [(graph.name, len(graph.motions)) for graph in reference_built.graphs] == [
        ("Full-Body", 8),
        ("Upper-Body", 7),
    ]
    for graph, report in zip(reference_built.graphs, reference_built.reports, strict=True):
        assert report.lost_motions == ()
        assert graph.transitions["cost"].max() < 1.0
        by_distance = np.sort(graph.transitions, order="distance")
        assert (np.diff(by_distance["cost"])[np.diff(by_distance["distance"]) > 0.0] > 0.0).all()
        assert not (graph.hops == UNREACHABLE).any()
        assert len(graph.transitions) > 50


@pytest.mark.mocap
def test_the_clips_as_first_published_give_the_same_graphs_up_to_rounding(
    reference_built: BuiltLibrary, build_reference: Callable[[str], BuiltLibrary]
) -> None:
    published = build_reference("reference-6channel")

    def marks(edges: tuple[Transition, ...]) -> set[tuple[int, ...]]:
        return {edge[:4] for edge in edges}

    for one, other in zip(reference_built.graphs, published.graphs, strict=True):
        assert one.motions == other.motions
        np.testing.assert_allclose(one.oms, other.oms, rtol=1e-5, atol=1e-3)
        assert marks(one.edges) == marks(other.edges)
