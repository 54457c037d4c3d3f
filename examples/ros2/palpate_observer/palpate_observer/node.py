"""The node: parameters, subscriptions and publishers around `Bridge`."""

from __future__ import annotations

import dataclasses

import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import WrenchStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Header

from .bridge import DIAGNOSTICS, RESULTS, Bridge, Publication, Settings

TYPES = {
    "builtin_interfaces/msg/Time": Time,
    "std_msgs/msg/Header": Header,
    "std_msgs/msg/Float64": Float64,
    "diagnostic_msgs/msg/DiagnosticArray": DiagnosticArray,
    "diagnostic_msgs/msg/DiagnosticStatus": DiagnosticStatus,
    "diagnostic_msgs/msg/KeyValue": KeyValue,
}

#: What a parameter that is left out has in its place: ROS declares no parameter without a type.
LEFT_OUT = {"slip_force_n": 0.0, "exponent": 0.0, "material": ""}


class ObserverNode(Node):
    """Subscribes `joint_states` and `wrench`, publishes results under `palpate/`."""

    def __init__(self) -> None:
        super().__init__("palpate_observer")
        usual = {field.name: field.default for field in dataclasses.fields(Settings)}
        given = {name: self.declare_parameter(name, LEFT_OUT.get(name, value)).value for name, value in usual.items()}
        settings = Settings(**{name: None if name in LEFT_OUT and not value else value for name, value in given.items()})
        self._bridge = Bridge(settings, TYPES)
        self._publishers_of_results = {name: self.create_publisher(Float64, f"palpate/{name}", 10) for name in RESULTS}
        self._publishers_of_results[DIAGNOSTICS] = self.create_publisher(DiagnosticArray, f"palpate/{DIAGNOSTICS}", 10)
        if settings.joint:
            self.create_subscription(JointState, "joint_states", self._joint_state, qos_profile_sensor_data)
        self.create_subscription(WrenchStamped, "wrench", self._wrench, qos_profile_sensor_data)

    def _joint_state(self, message: JointState) -> None:
        self._publish(self._bridge.joint_state(message, self.get_clock().now().nanoseconds))

    def _wrench(self, message: WrenchStamped) -> None:
        self._publish(self._bridge.wrench(message, self.get_clock().now().nanoseconds))

    def _publish(self, publications: list[Publication]) -> None:
        for topic, message in publications:
            self._publishers_of_results[topic].publish(message)


def main() -> None:
    """Runs the node until it is shut down."""
    rclpy.init()
    node = ObserverNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
