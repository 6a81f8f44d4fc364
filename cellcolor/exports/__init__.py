"""What other programs read: joints as CSV, ROS 2 trajectories, programs for controllers."""
