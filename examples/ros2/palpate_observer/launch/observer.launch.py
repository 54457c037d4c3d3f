"""Launch the observer beside a gripper.

    ros2 launch palpate_observer observer.launch.py params:=my_gripper.yaml joint_states:=/gripper/joint_states wrench:=/ft/wrench
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """The node with its parameters and the topics of the gripper."""
    usual = PathJoinSubstitution([FindPackageShare("palpate_observer"), "config", "observer.yaml"])
    node = Node(
        package="palpate_observer",
        executable="observer",
        parameters=[LaunchConfiguration("params")],
        remappings=[
            ("joint_states", LaunchConfiguration("joint_states")),
            ("wrench", LaunchConfiguration("wrench")),
        ],
        output="screen",
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("params", default_value=usual, description="Parameters (YAML)"),
            DeclareLaunchArgument("joint_states", default_value="/joint_states", description="sensor_msgs/JointState"),
            DeclareLaunchArgument("wrench", default_value="/wrench", description="geometry_msgs/WrenchStamped"),
            node,
        ]
    )
