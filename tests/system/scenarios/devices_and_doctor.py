"""`pleinair devices` lists the camera and the loopback with what they can do; `pleinair doctor` finds them
well, and says what is wrong once they are gone."""
import json

import live


def run(guest):
    live.load_drivers(guest)
    devices = json.loads(guest.run("./pleinair devices --json").output)
    (camera,) = devices["cameras"]
    assert camera["backend"] == "v4l2", camera
    assert camera["node"] == live.CAMERA, camera
    assert "vivid" in camera["id"], camera
    assert camera["problem"] is None, camera
    formats = {entry["layout"]: entry for entry in camera["formats"]}
    assert {"YUYV", "NV12", "GREY", "RGGB"} <= set(formats), sorted(formats)
    assert formats["YUYV"]["read"], formats["YUYV"]
    (loopback,) = [output for output in devices["outputs"] if output["kind"] == "loopback"]
    assert loopback["target"] == f"loopback:{live.LOOPBACK}", loopback
    assert not loopback["busy"], loopback
    assert {"YUYV", "NV12", "YU12"} <= set(loopback["formats"]), loopback

    checks = doctor(guest)
    assert "ES 3." in find(checks, "OpenGL ES")["text"], checks  # software, of which it warns
    for check in ("cameras", "loopback", "udev"):
        assert verdict(checks, check) == "ok", checks

    guest.run("modprobe -r v4l2loopback vivid")
    checks = doctor(guest)
    assert verdict(checks, "loopback") != "ok", checks
    assert "modprobe v4l2loopback" in remedy(checks, "loopback"), checks


def doctor(guest):
    # Its exit status says whether anything is wrong; the findings are in its text.
    return json.loads(guest.run("./pleinair doctor --json", seconds=40, check=False).output)["checks"]


def find(checks, word):
    return next(check for check in checks if word.lower() in check["check"].lower())


def verdict(checks, word):
    return find(checks, word)["verdict"]


def remedy(checks, word):
    return find(checks, word)["remedy"]
