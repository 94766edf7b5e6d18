"""Rectified images of a stereo camera in, disparities, points and damage out."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    """Start the node in a container of its own."""
    node = ComposableNode(
        package='roadstereo_ros',
        plugin='roadstereo_ros::RoadStereoNode',
        namespace=LaunchConfiguration('camera'),
        parameters=[{'preset': LaunchConfiguration('preset')}])
    return LaunchDescription([
        DeclareLaunchArgument('camera', default_value='stereo'),  # namespace of left/ and right/
        DeclareLaunchArgument('preset', default_value='default'),  # or fast, paper
        ComposableNodeContainer(
            name='roadstereo_container',
            namespace='',
            package='rclcpp_components',
            executable='component_container',
            composable_node_descriptions=[node]),
    ])
