#!/usr/bin/env python3
"""Who may control RAUC: the image's policy after Debian's, judged by D-Bus's own daemon."""
import os
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import grub  # noqa: E402

POLICY = os.path.join(grub.IMAGE, "root", "etc", "dbus-1", "system.d", "pleinair.conf")
NOBODY = "65534"
# The system bus's own rules, as far as they matter here, and those of Debian's rauc-service 1.8.
CONFIGURATION = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-BUS Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig>
  <type>system</type><listen>unix:path={socket}</listen><auth>EXTERNAL</auth>
  <policy context="default">
    <allow user="*"/><deny own="*"/><deny send_type="method_call"/>
    <allow send_type="signal"/><allow send_requested_reply="true" send_type="method_return"/>
    <allow send_requested_reply="true" send_type="error"/><allow receive_type="method_call"/>
    <allow receive_type="method_return"/><allow receive_type="error"/><allow receive_type="signal"/>
    <allow send_destination="org.freedesktop.DBus"/>
  </policy>
  <policy context="default"><allow send_destination="de.pengutronix.rauc"/></policy>
  <policy user="root"><allow own="de.pengutronix.rauc"/></policy>
  {include}
</busconfig>
"""


def call(member, serial, *arguments):
    """A method call of the bus itself. Arguments: one string and one number, or none."""
    def string(text):
        return struct.pack("<I", len(text)) + text.encode() + b"\0"

    def field(code, kind, value):
        return bytes([code, 1]) + kind + b"\0" + value

    body = b""
    if arguments:
        body = string(arguments[0])
        body += b"\0" * (-len(body) % 4) + struct.pack("<I", arguments[1])
    fields = b""
    for each in (field(1, b"o", string("/org/freedesktop/DBus")), field(2, b"s", string("org.freedesktop.DBus")),
                 field(3, b"s", string(member)), field(6, b"s", string("org.freedesktop.DBus")),
                 *([field(8, b"g", b"\2su\0")] if arguments else [])):
        fields += b"\0" * (-len(fields) % 8) + each
    head = struct.pack("<cBBBIII", b"l", 1, 0, 1, len(body), serial, len(fields)) + fields
    return head + b"\0" * (-len(head) % 8) + body


def missing():
    if os.geteuid() != 0:
        return "only root can be two users"
    return next((each + " is not installed" for each in ("dbus-daemon", "dbus-send", "setpriv") if not shutil.which(each)), None)


@unittest.skipIf(missing(), missing())
class Bus(unittest.TestCase):
    def begin(self, include):
        """A bus on which root has RAUC's name, and answers nothing."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        os.chmod(folder.name, 0o755)
        self.place = os.path.join(folder.name, "socket")
        file = os.path.join(folder.name, "bus.conf")
        with open(file, "w") as text:
            text.write(CONFIGURATION.format(socket=self.place, include=include))
        daemon = subprocess.Popen(["dbus-daemon", "--nofork", "--nosyslog", "--config-file=" + file], stderr=subprocess.DEVNULL)
        self.addCleanup(daemon.wait)
        self.addCleanup(daemon.kill)
        owner = socket.socket(socket.AF_UNIX)
        self.addCleanup(owner.close)
        for _ in range(100):
            try:
                owner.connect(self.place)
                break
            except OSError:
                time.sleep(0.1)
        owner.sendall(b"\0AUTH EXTERNAL 30\r\nBEGIN\r\n" + call("Hello", 1) + call("RequestName", 2, "de.pengutronix.rauc", 4))
        time.sleep(0.5)

    def answer(self, user):
        done = subprocess.run(["setpriv", "--reuid", user, "--clear-groups", "dbus-send", f"--bus=unix:path={self.place}",
                               "--print-reply", "--reply-timeout=500", "--dest=de.pengutronix.rauc", "/",
                               "de.pengutronix.rauc.Installer.Mark", "string:bad", "string:booted"],
                              capture_output=True, text=True, timeout=30)
        return done.stderr

    def test_only_root_controls_rauc(self):
        self.begin(f"<include>{POLICY}</include>")
        self.assertIn("AccessDenied", self.answer(NOBODY))
        self.assertIn("NoReply", self.answer("0"))

    def test_debians_policy_alone_lets_everybody(self):
        self.begin("")
        self.assertIn("NoReply", self.answer(NOBODY))


if __name__ == "__main__":
    unittest.main()
