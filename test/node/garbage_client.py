#!/usr/bin/python3
"""One of the clients of garbage_test.py: CALLS SEED; prints as JSON what was taken of its garbage."""
import json
import os
import sys

import rospy

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from garbage import flood  # noqa: E402

rospy.init_node("garbage_client", anonymous=True, disable_signals=True)
print(json.dumps(flood(int(sys.argv[1]), int(sys.argv[2]))))
