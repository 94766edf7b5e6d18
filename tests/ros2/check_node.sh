#!/usr/bin/env bash
# Checks ros2/roadstereo_ros as far as Debian goes, where there is no rclcpp: ament's lints, the message texts of
# src/io/ros by ROS 2's own generator, the conversions compiled against its headers, the node against stand-ins.
#   tests/ros2/check_node.sh BUILD     BUILD: a configured build of this project, for the generated version.hpp
# Needs ament-cmake-xmllint, ament-cmake-lint-cmake, ament-cmake-flake8, ament-cmake-pep257, rosidl-tools,
# rosidl-generator-c-cpp, python3-ament-index and librosidl-runtime-c-cpp-dev. Without them it exits with 77, skipped.
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "$0")/../.."

for tool in ament_xmllint ament_lint_cmake ament_flake8 ament_pep257 rosidl; do
  command -v "$tool" >/dev/null || { echo "$tool is missing"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

package=ros2/roadstereo_ros
ament_xmllint "$package/package.xml"
ament_lint_cmake "$package/CMakeLists.txt"
ament_flake8 "$package/launch"
ament_pep257 "$package/launch"

# One file per type: PACKAGE/msg/NAME.msg.
for text in src/io/ros/*.msg; do
  name=$(basename "$text" .msg)
  home=$(grep -o "\"[a-z_0-9]*/msg/$name\"" src/io/ros/flight_messages.cpp | tr -d '"' | cut -d/ -f1)
  { echo "MSG: $home/$name"; cat "$text"; } | awk -v work="$work" '
    /^=+$/ { next }
    /^MSG: / { split($2, part, "/"); folder = work "/" part[1] "/msg"; system("mkdir -p " folder)
               file = folder "/" part[2] ".msg"; printf "" > file; next }
    { print > file }'
done
for folder in "$work"/*/; do
  of=$(basename "$folder")
  rosidl generate -o "$work/include/$of" -t cpp -I "$work" "$of" \
    $(find "$folder" -name '*.msg' -printf "$folder:%P\n") >"$work/log" || { cat "$work/log"; exit 1; }
done

flags=(-std=c++20 -fsyntax-only -Wall -Wextra -Wconversion -Wshadow -Werror -Iinclude "-I$build/generated"
       -isystem "$work/include" -isystem /usr/include/rosidl_runtime_c -isystem /usr/include/rosidl_runtime_cpp
       -isystem /usr/include/rosidl_typesupport_interface)
for source in "$package"/src/*.cpp; do
  c++ "${flags[@]}" -Itests/ros2/stand_ins "$source"
done
echo "$package: lints, $(find "$work" -name '*.msg' | wc -l) message types, $(ls "$package"/src/*.cpp | wc -l) sources"
