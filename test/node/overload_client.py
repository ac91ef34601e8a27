#!/usr/bin/python3
"""What overload_test.py has beside it. `flood SECONDS` calls cheap services as fast as they answer and prints the
seconds that each took, as JSON; `listen` subscribes to every topic and says "ready" when messages come."""
import itertools
import json
import os
import sys
import threading
import time

import rospy
import rostopic

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import Chip  # noqa: E402


def flood(seconds):
    chip = Chip()
    calls = itertools.cycle([
        lambda: chip.get_state(False), lambda: chip.set_electrodes([1]), lambda: chip.get_layout(),
        lambda: chip.set_electrodes([9]), lambda: chip.detect_shorts(), lambda: chip.explain_droplet(99)])
    took = []
    end = time.monotonic() + seconds
    for call in calls:
        start = time.monotonic()
        if start > end:
            break
        call()
        took.append(time.monotonic() - start)
    print(json.dumps(took))


def listen():
    heard = {}
    enough = threading.Event()

    def note(topic):
        heard[topic] = True
        if {"/chip/state", "/chip/particles", "/chip/markers"} <= heard.keys():
            enough.set()

    for topic, kind in rospy.get_published_topics():
        message, _, _ = rostopic.get_topic_class(topic)
        if message:
            rospy.Subscriber(topic, message, lambda _, name=topic: note(name), buff_size=2**16)
    enough.wait(30)
    print("ready", flush=True)
    time.sleep(1000)  # stopped by a signal


rospy.init_node("overload_client", anonymous=True, disable_signals=True)
if sys.argv[1] == "flood":
    flood(float(sys.argv[2]))
else:
    listen()
