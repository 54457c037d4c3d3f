"""Observe a grip on a soft object in ROS 2: `bridge` needs no ROS, `node` is the node around it."""
