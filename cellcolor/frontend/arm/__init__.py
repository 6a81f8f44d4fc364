"""The robot arm: its URDF files, forward and inverse kinematics, and conditioning."""
