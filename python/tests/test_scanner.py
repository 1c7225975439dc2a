# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Lidars against closed forms and readers of others; times of rays."""
import numpy as np
import pytest

import caplet
from caplet import sensors
from caplet.sensors import Scanner, scan

SPEED = 6.0


def wall_at(x, thickness=1.0):
    scene = caplet.Scene()
    scene.add_boxes([x, -100, -100], [x + thickness, 100, 100], name="wall")
    return scene


def moving_ball():
    """A ball whose middle is at (0, 0, 4 t), t the seconds from 0 to 1, by capsules that move and by an instance that does."""
    scene = caplet.Scene()
    scene.add_capsules([[0, 0, 0]], [[0, 0, 0]], 1).animate([0, 1], p0=[[[0, 0, 0]], [[0, 0, 4]]], p1=[[[0, 0, 0]], [[0, 0, 4]]])
    return scene


def test_rays_have_times():
    scene, times = moving_ball(), np.linspace(0, 1, 9)
    up = np.tile([0.0, 0, 1], (9, 1))
    assert np.abs(caplet.trace(scene, (0, 0, -10), up, time=times)["t"] - (9 + 4 * times)).max() < 1e-5
    assert caplet.trace(scene, (0, 0, -10), (0, 0, 1))["t"].tolist() == [9.0]  # time 0
    assert caplet.trace(scene, (0, 0, -10), (0, 0, 1), time=0.25)["t"].tolist() == [10.0]
    # Before the shutter opens and after it closes it stands still.
    assert caplet.trace(scene, (0, 0, -10), up[:3], time=[-1, 7, np.nan])["t"].tolist() == [9.0, 13.0, 9.0]
    lists = caplet.trace(scene, (0, 0, -10), up, mode="all", time=times)
    assert np.abs(lists["t"].reshape(9, 2) - (np.array([[9, 11]]) + 4 * times[:, None])).max() < 1e-5
    assert caplet.trace(scene, (-10, 0, 4), np.tile([1.0, 0, 0], (2, 1)), mode="any", time=[0.5, 0.9]).tolist() == [False, True]
    with pytest.raises(caplet.InputError, match="time"):
        caplet.trace(scene, (0, 0, -10), up, time=[0, 1])


def test_times_are_those_of_the_shutter(tmp_path):
    (tmp_path / "s.pbrt").write_text("""Camera "perspective" "float shutteropen" 2 "float shutterclose" 4
TransformTimes 2 4
WorldBegin
ObjectBegin "ball" Shape "sphere" ObjectEnd
ActiveTransform EndTime Translate 0 0 8 ActiveTransform All
ObjectInstance "ball"
""")
    hits = caplet.trace(caplet.load(tmp_path / "s.pbrt"), (0, 0, -10), np.tile([0.0, 0, 1], (4, 1)), time=[0, 2, 2.5, 9])
    assert np.abs(hits["t"] - [9, 9, 11, 17]).max() < 1e-4


def test_rays_of_many_chunks_keep_their_times():
    count = (1 << 18) + 1000  # more than the library sends at once
    times = np.linspace(0, 1, count)
    hits = caplet.trace(moving_ball(), (0, 0, -10), np.tile(np.float32([0, 0, 1]), (count, 1)), time=times)
    assert np.abs(hits["t"] - (9 + 4 * times)).max() < 1e-5


def test_a_spinning_scanner_fires_as_it_says():
    scanner = Scanner.spinning([-10, 5], steps=8, rate=20, turns=2, azimuths=[0, 3], delays=[0, 1e-4], start=30)
    assert scanner.directions.shape == (32, 3) and scanner.rings.tolist() == [0, 1] * 16
    step = np.repeat(np.arange(16), 2)
    times = step / 160 + np.tile([0, 1e-4], 16)
    assert np.abs(scanner.times - times).max() < 1e-12
    azimuth = 30 + 360 * 20 * times + np.tile([0, 3], 16)
    seen = np.rad2deg(np.arctan2(scanner.directions[:, 1], scanner.directions[:, 0]))
    assert np.abs((seen - azimuth + 180) % 360 - 180).max() < 1e-9
    assert np.abs(np.rad2deg(np.arcsin(scanner.directions[:, 2])) - np.tile([-10, 5], 16)).max() < 1e-9


def test_ranges_and_intensities_of_a_floor():
    floor = caplet.Scene()
    floor.add_boxes([-1000, -1000, -1], [1000, 1000, 0], name="floor")
    pose = np.eye(4)
    pose[:3, 3] = (3, 4, 2)
    down = np.array([10.0, 30, 60])
    scanner = Scanner.spinning(-down, steps=12, rate=10)
    made = scan(floor, scanner, pose, reflectance=0.5)
    slant = np.sin(np.deg2rad(down))[made["ring"]]
    assert len(made) == 36 and (made["firing"] == np.arange(36)).all() and (made["number"] == 1).all() and (made["count"] == 1).all()
    assert np.abs(made["range"] - 2 / slant).max() < 2e-5
    assert np.abs(made["intensity"] / (0.5 * slant / (2 / slant) ** 2) - 1).max() < 1e-5
    assert np.abs(made["world"][:, 2]).max() < 2e-5 and np.abs(made["point"][:, 2] + 2).max() < 2e-5
    assert np.abs(made["world"] - pose[:3, 3] - made["point"]).max() < 1e-5
    assert np.abs(made["t"] - scanner.times).max() == 0
    # A turned scanner's own places are turned back.
    pose[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    turned = scan(floor, scanner, pose)
    assert np.abs((turned["world"] - pose[:3, 3]) @ pose[:3, :3] - turned["point"]).max() < 1e-5


def test_a_scanner_that_drives_towards_a_wall():
    scanner = Scanner(np.tile([1.0, 0, 0], (11, 1)), times=np.linspace(0, 1, 11))

    def pose(times):
        out = np.tile(np.eye(4), (len(times), 1, 1))
        out[:, 0, 3] = SPEED * times
        return out
    made = scan(wall_at(10), scanner, pose)
    assert np.abs(made["range"] - (10 - SPEED * scanner.times)).max() < 1e-5 and np.abs(made["world"][:, 0] - 10).max() < 1e-5
    # And one that stands while a ball comes.
    towards = Scanner(np.tile([0.0, 0, 1], (5, 1)), times=np.linspace(0, 1, 5))
    pose_below = np.eye(4)
    pose_below[2, 3] = -10
    assert np.abs(scan(moving_ball(), towards, pose_below)["range"] - (9 + 4 * towards.times)).max() < 1e-5


def panes():
    """Two panes of glass at x = 1 and 2, 0.5 thick, before a wall at x = 4."""
    scene = wall_at(4)
    for x in (1.0, 2.0):
        scene.add_boxes([x, -9, -9], [x + 0.5, 9, 9], name=f"pane {x:g}")
    return scene


def test_returns_through_what_lets_light_through():
    forwards, through, shine = Scanner([(1, 0, 0)]), [0, 0.5, 0.5], [1, 0.04, 0.08]
    made = scan(panes(), forwards, np.eye(4), mode="all", transmittance=through, reflectance=shine)
    assert np.abs(made["range"] - [1, 1.5, 2, 2.5, 4]).max() < 1e-6 and made["shape"].tolist() == [1, 1, 2, 2, 0]
    wanted = np.array([0.04, 0.5 * 0.04 / 2.25, 0.25 * 0.08 / 4, 0.125 * 0.08 / 6.25, 0.0625 / 16])
    assert np.abs(made["intensity"] / wanted - 1).max() < 1e-5
    assert made["number"].tolist() == [1, 2, 3, 4, 5] and (made["count"] == 5).all()

    def ranges(mode, **more):
        given = {"transmittance": through, "reflectance": shine, **more}
        return scan(panes(), forwards, np.eye(4), mode=mode, **given)["range"].tolist()
    assert ranges("first") == [1] and ranges("last") == [4] and ranges("strongest") == [1] and ranges("dual") == [1, 4]
    assert ranges("strongest", reflectance=[1, 1e-4, 1e-4]) == [4] and ranges("dual", reflectance=[1, 1e-4, 1e-4]) == [4]
    assert ranges("last", threshold=0.005) == [2] and ranges("all", threshold=1) == []
    assert ranges("all", transmittance=0.0) == [1]
    assert ranges("all", transmittance=[0, 0.5, 0]) == [1, 1.5, 2]
    near = Scanner([(1, 0, 0)], near=1.2, far=3)  # what is nearer takes its part of the light all the same
    made = scan(panes(), near, np.eye(4), mode="all", transmittance=through)
    assert np.abs(made["range"] - [1.5, 2, 2.5]).max() < 1e-6 and abs(made["intensity"][0] - 0.5 / 2.25) < 1e-6
    # Panes that reflect nothing make no returns.
    assert ranges("strongest", reflectance=[1, 0, 0], transmittance=[0, 1, 1]) == [4]


def test_what_is_lost_and_how_ranges_are_measured():
    scanner, wall = Scanner(np.tile([1.0, 0, 0], (20000, 1))), wall_at(10)
    kept = scan(wall, scanner, np.eye(4), dropout=0.3, seed=4)
    # Five standard deviations of a binomial distribution.
    assert abs(len(kept) - 14000) < 5 * np.sqrt(20000 * 0.3 * 0.7)
    assert (scan(wall, scanner, np.eye(4), dropout=0.3, seed=4)["firing"] == kept["firing"]).all()
    assert len(scan(wall, scanner, np.eye(4), dropout=lambda of: np.where(of < 0.02, 1, 0))) == 0  # 1 / 100 is returned
    assert len(scan(wall, scanner, np.eye(4), dropout=lambda of: np.where(of > 0.02, 1, 0))) == 20000
    noisy = scan(wall, scanner, np.eye(4), noise=0.05)
    assert abs(noisy["range"].mean() - 10) < 5 * 0.05 / np.sqrt(20000) and abs(noisy["range"].std() / 0.05 - 1) < 5 / np.sqrt(40000)
    assert np.abs(noisy["point"][:, 0] - noisy["range"]).max() < 1e-6
    by_range = scan(wall, scanner, np.eye(4), noise=lambda ranges: 0.01 * ranges)
    assert abs(by_range["range"].std() / 0.1 - 1) < 5 / np.sqrt(40000)
    coarse = scan(wall, scanner, np.eye(4), noise=0.05, quantum=0.04)["range"] / np.float32(0.04)
    assert np.abs(coarse - np.rint(coarse)).max() < 1e-3 and len(np.unique(np.rint(coarse))) > 5
    assert abs(coarse.mean() * 0.04 - 10) < 5 * 0.06 / np.sqrt(20000)


def test_files_of_returns(tmp_path):
    pose = np.eye(4)
    pose[:3, 3] = (-3, 2, 1)
    made = scan(panes(), Scanner([(1, 0, 0), (1, 0.1, 0), (-1, 0, 0)], times=[0, 0.25, 0.5], rings=[7, 8, 9]), pose, mode="all",
                transmittance=[0, 0.5, 0.5])
    assert len(made) == 10
    sensors.save_returns(tmp_path / "r.npy", made)
    assert (np.load(tmp_path / "r.npy") == made).all()
    sensors.save_returns(tmp_path / "r.bin", made)
    rows = np.fromfile(tmp_path / "r.bin", "<f4").reshape(-1, 4)
    assert (rows[:, :3] == made["point"]).all() and (rows[:, 3] == made["intensity"]).all()
    sensors.save_returns(tmp_path / "r.ply", made, world=True)
    head, _, body = (tmp_path / "r.ply").read_bytes().partition(b"end_header\n")
    assert b"element vertex 10\n" in head and b"property ushort ring\nproperty double t\n" in head and len(body) == 10 * (4 * 4 + 2 + 8)
    assert np.frombuffer(body[:12], "<f4").tolist() == made["world"][0].astype(np.float32).tolist()
    assert np.frombuffer(body[16:18], "<u2")[0] == 7
    for wrong, why in (("r.xyz", "needed"), ("no/such/r.bin", "r.bin")):
        with pytest.raises(caplet.InputError, match=why):
            sensors.save_returns(tmp_path / wrong, made)
    with pytest.raises(caplet.InputError, match="RETURN"):
        sensors.save_returns(tmp_path / "r.bin", np.zeros((3, 3)))


def test_las_is_read_by_laspy(tmp_path):
    laspy = pytest.importorskip("laspy")
    made = scan(panes(), Scanner([(1, 0, 0), (1, 0.1, 0)], times=[0, 0.25], rings=[7, 8]), np.eye(4), mode="all", transmittance=[0, 0.5, 0.5])
    sensors.save_returns(tmp_path / "r.las", made)
    las = laspy.read(tmp_path / "r.las")
    assert len(las.points) == 10 and str(las.header.version) == "1.4"
    assert np.abs(np.column_stack([las.x, las.y, las.z]) - made["point"]).max() < 0.0006  # half a step of 0.001, and rounding
    assert las.intensity.max() == 65535 and np.abs(las.intensity / 65535 - made["intensity"] / made["intensity"].max()).max() < 1e-5
    assert (las.return_number == made["number"]).all() and (las.number_of_returns == made["count"]).all()
    assert (las.gps_time == made["t"]).all() and (las.point_source_id == made["ring"]).all()
    sensors.save_returns(tmp_path / "none.las", made[:0])
    assert len(laspy.read(tmp_path / "none.las").points) == 0


def test_things_of_several_shapes():
    scene = caplet.Scene()
    for x in (-1.0, 0.0, 1.0):
        scene.add_spheres((x, 0, 5), 0.4, name=f"ball {x:g}")
    camera = sensors.Pinhole(64, 48, fx=50)
    alone = sensors.segment(scene, camera, np.eye(4))
    things = sensors.segment(scene, camera, np.eye(4), of=np.array([3, 1, 3]))
    assert [(one["shape"], one["name"]) for one in things] == [(1, "ball 0"), (3, "ball -1")]
    assert (things[0]["mask"] == alone[1]["mask"]).all() and (things[1]["mask"] == (alone[0]["mask"] | alone[2]["mask"])).all()
    assert things[1]["amodal_area"] == alone[0]["amodal_area"] + alone[2]["amodal_area"]
    for wrong in ([0, 1], [0.5, 1, 2], [-1, 0, 1]):
        with pytest.raises(caplet.InputError, match="of: a whole number"):
            sensors.segment(scene, camera, np.eye(4), of=np.array(wrong))


def test_scenes_without_anything():
    assert len(scan(caplet.Scene(), Scanner([(1, 0, 0)]), np.eye(4))) == 0
    assert len(scan(wall_at(10), Scanner(np.empty((0, 3))), np.eye(4))) == 0
    assert len(scan(wall_at(10), Scanner([(-1, 0, 0)]), np.eye(4), transmittance=1.0)) == 0


WALL = wall_at(10)
FORWARDS = Scanner([(1, 0, 0)])


@pytest.mark.parametrize("wrong, why", [
    (lambda: Scanner([(0, 0, 0)]), "directions"), (lambda: Scanner([1, 0, 0]), "directions"), (lambda: Scanner([(1, 0, 0)], times=[0, 1]), "times"),
    (lambda: Scanner([(1, 0, 0)], near=2, far=1), "near"), (lambda: Scanner.spinning([], 4), "elevations"), (lambda: Scanner.spinning([0], 0), "steps"),
    (lambda: Scanner.spinning([0], 4, rate=0), "rate"), (lambda: Scanner.spinning([0, 1], 4, delays=[0, 0, 0]), "delays"),
    (lambda: scan(WALL, FORWARDS, np.eye(3)), "pose"), (lambda: scan(WALL, FORWARDS, lambda times: np.zeros((5, 4, 4))), "pose"),
    (lambda: scan(WALL, FORWARDS, np.eye(4), mode="best"), "mode"), (lambda: scan(WALL, FORWARDS, np.eye(4), reflectance=2), "reflectance"),
    (lambda: scan(WALL, FORWARDS, np.eye(4), transmittance=[0, 1]), "transmittance")])
def test_wrong_input_is_named(wrong, why):
    with pytest.raises(caplet.InputError, match=why):
        wrong()


def test_tables_of_firings(tmp_path):
    table = tmp_path / "pattern.csv"

    def of(text):
        table.write_text(text)
        return Scanner.from_table(table, far=50)

    livox = of("Time/s,Azimuth/deg,Zenith/deg\n0.0,0,90\n1e-5,90,60\n2e-5,180,180\n")
    assert np.abs(livox.directions - [[1, 0, 0], [0, np.sqrt(3) / 2, 0.5], [0, 0, -1]]).max() < 1e-12
    assert livox.times.tolist() == [0.0, 1e-5, 2e-5] and livox.rings.tolist() == [0, 0, 0] and livox.far == 50
    same = of("ring azimuth_rad elevation_deg time_us power\n7 0 0 0 1\n2 1.5707963267948966 30 10 1\n65535 3.141592653589793 -90 20 1\n")
    assert np.abs(same.directions - livox.directions).max() < 1e-12 and np.abs(same.times - livox.times).max() < 1e-18
    assert same.rings.tolist() == [7, 2, 65535]
    assert of("x y z\n2 0 0\n0 3 4\n").directions.tolist() == [[1, 0, 0], [0, 0.6, 0.8]]
    assert len(scan(wall_at(5.0), of("azimuth elevation\n0 0\n180 0\n"), np.eye(4))) == 1


@pytest.mark.parametrize("text, says", [
    ("", "1: columns azimuth"), ("azimuth\n1\n", "1: columns azimuth"), ("x y\n1 2\n", "x, y and z"), ("x y z\n", "no firings"), ("x y z\n1 2\n", ":2: 3 numbers"),
    ("x y z\n1 2 3\n1 a 3\n", ":3: 3 numbers"), ("x,y,z\n1,2,3,4\n", ":2: 3 numbers"), ("x y z x\n1 2 3 4\n", "two columns are x"), ("x y z\n0 0 0\n", "no row of zeros"),
    ("x y z\n1 2 nan\n", "finite"), ("azimuth zenith time_h\n1 2 nan\n0 0 0\n", None),
])
def test_tables_that_are_none(tmp_path, text, says):
    (tmp_path / "t.csv").write_text(text)
    if says is None:  # a column of no known unit is another one
        assert Scanner.from_table(tmp_path / "t.csv").times.tolist() == [0.0, 0.0]
        return
    with pytest.raises(caplet.InputError, match=says):
        Scanner.from_table(tmp_path / "t.csv")
    with pytest.raises(caplet.InputError, match="No such file"):
        Scanner.from_table(tmp_path / "none.csv")
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(caplet.InputError, match="is no text"):
        Scanner.from_table(tmp_path / "b.csv")
