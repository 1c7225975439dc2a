# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Sensors against closed forms, OpenCV's numbers, and readers of others."""
import json
import os
import pathlib
import re
import struct
import zlib

import numpy as np
import pytest

import caplet
from caplet import sensors
from caplet.sensors import Pinhole

SOURCE = pathlib.Path(os.environ["CAPLET_SOURCE"])


def turned(angle, axis=(0, 1, 0), at=(0, 0, 0)):
    """A pose that is turned about a unit axis (Rodrigues)."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    out = np.eye(4)
    out[:3, :3] += np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    out[:3, 3] = at
    return out


def calibrated():
    """(intrinsics, distortion in OpenCV's order, points with the pixels of OpenCV 5.0.0's projectPoints) of 20 cameras."""
    text = (SOURCE / "tests/sampling/opencv_camera_test.cpp").read_text()
    for parts in re.findall(r"\{\{([-\d., e]+)\},\s*\{([-\d., e]+)\},\s*\{\{(.*?)\}\}\}", text, re.DOTALL):
        yield [np.array([[float(v) for v in row.split(",")] for row in re.findall(r"[-\d][-\d., e]*", part)]) for part in parts]


def test_projections_are_those_of_opencv():
    count = 0
    for (intrinsics,), (distortion,), points in calibrated():
        width, height, fx, fy, cx, cy = intrinsics
        camera = Pinhole(int(width), int(height), fx, fy, cx, cy, distortion)
        assert np.abs(camera.project(points[:, :3]) - points[:, 3:]).max() < 1e-8  # it was written with 9 decimals
        assert np.abs(camera.unproject(points[:, 3:]) - points[:, :3] / points[:, 2:3]).max() < 1e-9
        count += len(points)
    assert count == 80


def test_derivatives_of_a_distortion():
    camera = Pinhole(64, 48, fx=50, distortion=(-0.2, 0.1, 0.003, -0.002, 0.05, 0.08, -0.03, 0.02))
    x, y, h = np.array([0.3, -0.4]), np.array([-0.2, 0.5]), 1e-6
    _, (xx, xy, yy) = camera._distorted(x, y)
    ends = [camera._distorted(x + dx, y + dy)[0] for dx, dy in ((h, 0), (-h, 0), (0, h), (0, -h))]
    for got, wanted in ((xx, ends[0][0] - ends[1][0]), (xy, ends[0][1] - ends[1][1]), (xy, ends[2][0] - ends[3][0]), (yy, ends[2][1] - ends[3][1])):
        assert np.abs(got - wanted / (2 * h)).max() < 1e-9  # h^2 of the third derivative, and rounding / h


def test_pixels_that_nobody_sees_have_no_direction():
    camera = Pinhole(200, 100, fx=60, distortion=(-0.4, 0, 0, 0))  # x (1 - 0.4 x^2) is at most 0.61
    ways = camera.unproject([[99.5 + 60 * 0.6, 49.5], [99.5 + 60 * 0.62, 49.5], [99.5, 49.5]])
    assert np.isfinite(ways[0]).all() and np.isnan(ways[1, 0]) and ways[2].tolist() == [0, 0, 1]
    assert abs(ways[0, 0] * (1 - 0.4 * ways[0, 0] ** 2) - 0.6) < 1e-12 and ways[0, 0] < (1 / 1.2) ** 0.5
    assert np.isnan(camera.project([(0, 0, -1), (0, 0, 0)])).all()


@pytest.fixture
def balls():
    """A ball that hides a part of a larger one behind it."""
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 4), 1, name="near")
    scene.add_spheres((0.8, 0.3, 7), 1.5, name="far")
    return scene


CAMERA = Pinhole(64, 48, fx=50, cx=30.25, cy=22.5)


def depth_of_ball(camera, pose, center, radius):
    """Depths along z by the quadratic equation; infinite where the ball is missed."""
    ways = np.column_stack([(camera.pixels() - [camera.cx, camera.cy]) / [camera.fx, camera.fy], np.ones(camera.width * camera.height)])
    at = np.linalg.inv(pose[:3, :3]) @ (np.asarray(center, float) - pose[:3, 3])
    a, b = (ways ** 2).sum(axis=1), ways @ at
    inside = b * b - a * (at @ at - radius * radius)
    return np.where(inside > 0, (b - np.sqrt(np.maximum(inside, 0))) / a, np.inf).reshape(camera.height, camera.width)


def test_depths_are_those_of_the_quadratic_equation(balls):
    pose = turned(0.1, at=(-0.2, 0.1, 0.3))
    near, far = (depth_of_ball(CAMERA, pose, *ball) for ball in (((0, 0, 4), 1), ((0.8, 0.3, 7), 1.5)))
    wanted = np.minimum(near, far)
    frame = sensors.depth_camera(balls, CAMERA, pose)
    is_there = np.isfinite(wanted)
    assert (np.isfinite(frame.depth) == is_there).mean() > 0.998  # rays that graze may do either
    both = is_there & np.isfinite(frame.depth)
    assert np.abs(frame.depth - wanted)[both & (frame.normal @ pose[:3, 2] < -0.1)].max() < 2e-5
    assert (frame.shape[both] == np.where(near < far, 0, 1)[both]).all() and (frame.shape[~np.isfinite(frame.depth)] == sensors.NOTHING).all()
    # Points lie on the balls, in the camera's space; ranges are their lengths.
    world = frame.points[both].astype(float) @ pose[:3, :3].T + pose[:3, 3]
    off = np.where(frame.shape[both] == 0, np.linalg.norm(world - [0, 0, 4], axis=1) - 1, np.linalg.norm(world - [0.8, 0.3, 7], axis=1) - 1.5)
    assert np.abs(off).max() < 1e-5
    along = sensors.depth_camera(balls, CAMERA, pose, kind="range")
    assert np.abs(along.depth[both] - np.linalg.norm(frame.points[both], axis=1)).max() < 2e-5
    assert np.abs(along.points[both] - frame.points[both]).max() < 2e-5


def test_limits_noise_and_steps(balls):
    pose = np.eye(4)
    true = sensors.depth_camera(balls, CAMERA, pose).depth
    cut = sensors.depth_camera(balls, CAMERA, pose, near=3.1, far=6)
    assert (np.isfinite(cut.depth) == ((true >= 3.1) & (true <= 6))).all() and (cut.shape[np.isnan(cut.depth)] == sensors.NOTHING).all()
    noisy = sensors.depth_camera(balls, CAMERA, pose, noise=lambda z: 0.01 * z, seed=3).depth
    off = ((noisy - true) / (0.01 * true))[np.isfinite(true)]
    # The mean of n normal numbers is within 4 / sqrt(n), their standard deviation within 4 / sqrt(2 n).
    assert abs(off.mean()) < 4 / off.size ** 0.5 and abs(off.std() - 1) < 4 / (2 * off.size) ** 0.5
    assert (sensors.depth_camera(balls, CAMERA, pose, noise=lambda z: 0.01 * z, seed=3).depth[np.isfinite(true)] == noisy[np.isfinite(true)]).all()
    steps = sensors.depth_camera(balls, CAMERA, pose, quantum=0.25).depth
    assert np.nanmax(np.abs(steps - true)) <= 0.125 + 1e-6 and set(np.unique(steps[np.isfinite(steps)] * 4) % 1) == {0}


def test_files_of_depth_and_points(balls, tmp_path):
    frame = sensors.depth_camera(balls, CAMERA, turned(0.1, at=(-0.2, 0.1, 0.3)))
    frame.save_png(tmp_path / "depth.png")
    data, at, chunks = (tmp_path / "depth.png").read_bytes(), 8, {}
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        chunks[name] = data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(name + chunks[name])
        at += 12 + size
    assert chunks[b"IHDR"] == struct.pack(">IIBBBBB", 64, 48, 16, 0, 0, 0, 0)
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(48, 129)
    assert not rows[:, 0].any()
    millimetres = np.ascontiguousarray(rows[:, 1:]).view(">u2")
    assert (millimetres == np.nan_to_num(np.rint(frame.depth.astype(float) * 1000))).all() and millimetres.max() > 6000
    frame.save_points(tmp_path / "points.npy", world=True)
    points = np.load(tmp_path / "points.npy")
    is_there = np.isfinite(frame.depth)
    assert points.shape == (is_there.sum(), 3)
    is_near = frame.shape[is_there] == 0
    assert np.abs(np.linalg.norm(points[is_near] - [0, 0, 4], axis=1) - 1).max() < 1e-5
    frame.save_points(tmp_path / "points.bin")
    kitti = np.fromfile(tmp_path / "points.bin", "<f4").reshape(-1, 4)
    assert (kitti[:, :3] == frame.points[is_there]).all() and not kitti[:, 3].any()
    frame.save_points(tmp_path / "points.ply", world=True)
    with pytest.raises(caplet.InputError, match="points.txt"):
        frame.save_points(tmp_path / "points.txt")
    with pytest.raises(caplet.InputError, match="No such file"):
        frame.save_png(tmp_path / "missing" / "depth.png")
    assert sorted(f.name for f in tmp_path.iterdir()) == ["depth.png", "points.bin", "points.npy", "points.ply"]
    trimesh = pytest.importorskip("trimesh")
    cloud = trimesh.load(tmp_path / "points.ply")
    assert np.abs(cloud.vertices - points).max() < 1e-6


def test_a_file_that_cannot_be_replaced_stays_alone(balls, tmp_path, monkeypatch):
    (tmp_path / "depth.png").write_bytes(b"before")

    def refuse(*_):
        raise OSError(28, "No space left on device")
    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(caplet.InputError, match="depth.png: No space left on device"):
        sensors.depth_camera(balls, CAMERA, np.eye(4)).save_png(tmp_path / "depth.png")
    assert [f.name for f in tmp_path.iterdir()] == ["depth.png"] and (tmp_path / "depth.png").read_bytes() == b"before"


def test_segments_know_what_is_hidden(balls):
    pose = np.eye(4)
    near, far = (np.isfinite(depth_of_ball(CAMERA, pose, *ball)) for ball in (((0, 0, 4), 1), ((0.8, 0.3, 7), 1.5)))
    first, second = sensors.segment(balls, CAMERA, pose)
    assert (first["name"], second["name"], first["shape"], second["shape"]) == ("near", "far", 0, 1)
    for one, whole, visible in ((first, near, near), (second, far, far & ~near)):
        assert (one["mask"] != visible).sum() <= 4 and (one["amodal_mask"] != whole).sum() <= 4  # of rays that graze
        for kind in ("", "amodal_"):
            rows, columns = np.nonzero(one[kind + "mask"])
            assert one[kind + "box"] == [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1] and one[kind + "area"] == len(rows)
    assert second["area"] < second["amodal_area"] - 100
    balls.add_spheres((0, 0, 4), 0.2, name="within")
    within = sensors.segment(balls, CAMERA, pose)[2]
    assert within["name"] == "within" and within["area"] == 0 and within["box"] is None and not within["mask"].any() and within["amodal_area"] > 10
    assert len(sensors.segment(balls, CAMERA, pose, amodal=False)) == 2


def test_coco_masks_are_read_back(balls, tmp_path):
    segments = sensors.segment(balls, CAMERA, np.eye(4))
    made = sensors.coco([("a.png", CAMERA, segments), ("b.png", CAMERA, segments[:1])], tmp_path / "a.json", categories={"near": "ball", "far": "ball"})
    read = json.loads((tmp_path / "a.json").read_text())
    assert read == made and [c["name"] for c in read["categories"]] == ["ball"] and [i["file_name"] for i in read["images"]] == ["a.png", "b.png"]
    assert [(a["id"], a["image_id"], a["category_id"]) for a in read["annotations"]] == [(1, 1, 1), (2, 1, 1), (3, 2, 1)]
    for row, one in zip(read["annotations"], segments):
        counts, size = row["segmentation"]["counts"], row["segmentation"]["size"]
        flat = np.concatenate([np.full(n, i % 2) for i, n in enumerate(counts)])
        assert (flat.reshape(size, order="F") == one["mask"]).all() and row["area"] == sum(counts[1::2]) == one["area"] and row["bbox"] == one["box"]
        assert row["amodal_bbox"] == one["amodal_box"]
    balls.add_spheres((0, 0, 4), 0.2, name="within")
    assert len(sensors.coco([("d.png", CAMERA, sensors.segment(balls, CAMERA, np.eye(4)))])["annotations"]) == 2, "what is hidden wholly has no mask"
    full = dict(segments[0], mask=np.ones((48, 64), bool), area=48 * 64)
    assert sensors.coco([("c.png", CAMERA, [full])])["annotations"][0]["segmentation"]["counts"] == [0, 48 * 64]


def test_flow_of_a_plane_and_of_what_moves():
    scene = caplet.Scene()
    scene.add_boxes([-50, -50, 5], [50, 50, 6], name="wall")
    scene.add_spheres((0, 0, 3), 0.5, name="ball")
    optical, moved = sensors.flow(scene, CAMERA, np.eye(4), turned(0, at=(0.2, 0, 0)))
    frame = sensors.depth_camera(scene, CAMERA, np.eye(4))
    assert not moved.any() and np.abs(optical[..., 0] + 50 * 0.2 / frame.depth).max() < 1e-4 and np.abs(optical[..., 1]).max() < 1e-4
    # A turn alone moves pixels as their directions turn, whatever their depth.
    turn = turned(0.05, axis=(1, 0, 0))
    optical, _ = sensors.flow(scene, CAMERA, np.eye(4), turn)
    wanted = CAMERA.project(CAMERA.unproject(CAMERA.pixels()) @ turn[:3, :3]) - CAMERA.pixels()
    assert np.abs(optical.reshape(-1, 2) - wanted).max() < 1e-3
    # The ball goes away from the camera and to the right; the wall stays.
    optical, moved = sensors.flow(scene, CAMERA, np.eye(4), np.eye(4), moved={1: turned(0, at=(0.3, 0, 1))})
    is_ball = frame.shape == 1
    assert not moved[~is_ball].any() and np.abs(moved[is_ball] - [0.3, 0, 1]).max() < 1e-6 and np.abs(optical[~is_ball]).max() < 1e-3
    points = frame.points[is_ball].astype(float)
    then = CAMERA.project(points + [0.3, 0, 1])
    assert np.abs(CAMERA.project(points) + optical[is_ball] - then).max() < 1e-3 and is_ball.sum() > 50
    # A camera that has passed the wall does not see it.
    assert np.isnan(sensors.flow(scene, CAMERA, np.eye(4), turned(0, at=(0, 0, 20)))[0]).all()


def test_flow_of_what_moves_by_itself():
    # A ball and a sheet go to the right, a capsule in an object turns a quarter about the axis of view.
    scene = caplet.Scene()
    ball = scene.add_spheres((-1, 0, 5), 0.5)
    sheet = scene.add_mesh([(0.5, -1, 5), (2, -1, 5), (2, 1, 5), (0.5, 1, 5)], [(0, 1, 2), (0, 2, 3)])
    scene.add_capsules((-1, 0, 0), (1, 0, 0), 0.1, object="rod")
    scene.add_instances("rod", [turned(0, at=(0, 0, 3))])
    ball.animate([0, 2], p0=[[(-1, 0, 5)], [(-0.8, 0, 5)]], p1=[[(-1, 0, 5)], [(-0.8, 0, 5)]])
    sheet.animate([0, 2], vertices=np.stack([sheet.vertices, sheet.vertices + [0, 0.4, 1]]))
    quarter = turned(np.pi / 2, axis=(0, 0, 1), at=(0, 0, 3))
    scene.animate_instance(0, [0, 2], [turned(0, at=(0, 0, 3)), quarter])
    scene.shutter(0, 2)
    optical, moved = sensors.flow(scene, CAMERA, np.eye(4), np.eye(4), times=(0, 2))
    frame = sensors.depth_camera(scene, CAMERA, np.eye(4))
    points = frame.points.astype(float)
    rod = (frame.shape != ball.number) & (frame.shape != sheet.number) & np.isfinite(frame.depth)
    for rows, wanted in ((frame.shape == ball.number, lambda p: p + [0.2, 0, 0]), (frame.shape == sheet.number, lambda p: p + [0, 0.4, 1]),
                         (rod, lambda p: np.stack([-p[:, 1], p[:, 0], p[:, 2]], 1))):
        assert rows.sum() > 30
        after = wanted(points[rows])
        assert np.abs(moved[rows] - (after - points[rows])).max() < 1e-5
        assert np.abs(optical[rows] - (CAMERA.project(after) - CAMERA.project(points[rows]))).max() < 1e-3
    # Half of the time, and what others move besides.
    half = sensors.flow(scene, CAMERA, np.eye(4), np.eye(4), times=(0, 1), moved={ball.number: turned(0, at=(0, 1, 0))})[1]
    assert np.abs(half[frame.shape == ball.number] - [0.1, 1, 0]).max() < 1e-5
    # Back from the later time, whose pixels see it elsewhere.
    back = sensors.flow(scene, CAMERA, np.eye(4), np.eye(4), times=(2, 0))[1]
    assert (np.abs(back - [-0.2, 0, 0]).max(2) < 1e-5).sum() > 30 and (np.abs(back - [0, -0.4, -1]).max(2) < 1e-5).sum() > 30
    # Without times nothing moves by itself.
    assert np.nanmax(np.abs(sensors.flow(scene, CAMERA, np.eye(4), np.eye(4))[1])) == 0
    for wrong in (1, (0, 1, 2), (0, np.nan)):
        with pytest.raises(caplet.InputError, match="times: two finite numbers"):
            sensors.flow(scene, CAMERA, np.eye(4), np.eye(4), times=wrong)


def test_events_of_light_that_grows_and_falls():
    # exp(t) - floor: log luminance is t, so events of 0.25 come at 0.25, 0.5 ... up to 1, and on the way back at 1.25 ... 2.
    floor, times = 1e-3, np.linspace(0, 2, 41)
    log = np.where(times <= 1, times, 2 - times)
    pictures = np.full((41, 2, 3), 0.5)
    pictures[:, 1, 2] = np.exp(log) - floor
    made = sensors.events(pictures, times, threshold=0.25, floor=floor)
    assert len(made) == 8 and (made["x"] == 2).all() and (made["y"] == 1).all()
    assert np.abs(made["t"] - [0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2]).max() < 1e-6
    assert made["polarity"].tolist() == [1] * 4 + [-1] * 4
    # Half as many pictures say the same of a light that is linear between them; colours count by luminance.
    rgb = np.repeat(pictures[::2, ..., None], 3, axis=3)
    assert np.abs(sensors.events(rgb, times[::2], threshold=0.25, floor=floor)["t"] - made["t"]).max() < 1e-6
    # Luminances of single precision reach a threshold a little early or late, and are no event more or less.
    for scale in (0.1, 1, 7):
        single = (scale * np.exp(log) - floor).astype(np.float32).reshape(-1, 1, 1)
        assert len(sensors.events(single, times, threshold=0.25, floor=floor)) == 8
    jump = sensors.events(np.stack([np.full((1, 1), 1.0), np.full((1, 1), np.exp(1.1))]), [0, 1], threshold=0.5, floor=1e-9)
    assert np.abs(jump["t"] - [0.5 / 1.1, 1 / 1.1]).max() < 1e-6


@pytest.mark.parametrize("wrong, why", [
    (lambda: Pinhole(0, 48, fx=50), "width"), (lambda: Pinhole(64, 48, fx=-1), "fx and fy"), (lambda: Pinhole(64, 48, fx=50, distortion=(1, 2, 3)), "distortion"),
    (lambda: sensors.depth_camera(caplet.Scene(), CAMERA, np.zeros((4, 4))), "pose: an invertible"),
    (lambda: sensors.depth_camera(caplet.Scene(), CAMERA, np.eye(4), kind="z"), "planar"),
    (lambda: sensors.flow(caplet.Scene(), CAMERA, np.eye(4), np.eye(3)), "next_pose"),
    (lambda: sensors.events(np.zeros((2, 3, 3)), [1, 1]), "ascending"), (lambda: sensors.events(np.zeros((2, 3, 3)), [0, 1], threshold=0), "threshold")])
def test_wrong_input_is_named(wrong, why):
    with pytest.raises(caplet.InputError, match=why):
        wrong()
