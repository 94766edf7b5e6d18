#!/usr/bin/env bash
# Feeds mutated inputs to a reader, under the address and undefined behaviour sanitizers.
#   scripts/fuzz.sh [READER] [SECONDS]    READER: request, journal, calibration, bag, track, image, trajectory or all
#                                         (default); 60 seconds each
# With clang++ libFuzzer mutates the inputs of tests/fuzz/seeds; without, g++ builds a program that replays them. New
# inputs are kept in build-fuzz/corpus, those that fail in build-fuzz.
set -euo pipefail
cd "$(dirname "$0")/.."

readers=(request journal calibration bag track image trajectory)
reader=${1:-all}
seconds=${2:-60}
[ "$reader" = all ] || readers=("$reader")

flags=(-std=c++20 -g -O1 -Iapps/roadstereo -Iinclude -Isrc -fno-sanitize-recover=all)
if command -v clang++ >/dev/null; then
  build=(clang++ "${flags[@]}" -fsanitize=fuzzer,address,undefined,float-cast-overflow)
  main=()
else
  build=(g++ "${flags[@]}" -fsanitize=address,undefined,float-cast-overflow)
  main=(tests/fuzz/replay.cpp)
fi

for name in "${readers[@]}"; do
  case $name in
    request) sources=(apps/roadstereo/live/request_head.cpp) libraries=() ;;
    journal) sources=(src/io/flight/frame_json.cpp) libraries=() ;;
    calibration)
      sources=(src/io/calibration_*.cpp src/io/opencv_*.cpp src/io/plain_yaml.cpp src/io/yaml_text.cpp src/io/k_txt.cpp
               src/io/*_calibration.cpp src/io/ros_camera_info.cpp src/io/camera_info.cpp src/io/file_bytes.cpp
               src/io/kalibr_camchain.cpp src/io/rig_camera.cpp src/io/rigid_transform.cpp src/io/zed_conf.cpp
               src/core/calibration.cpp)
      libraries=($(pkg-config --cflags --libs opencv4 yaml-cpp pugixml)) ;;
    bag)
      sources=(src/io/source/message_log.cpp src/io/source/mcap_*.cpp src/io/source/decompress.cpp
               src/io/source/sqlite_log.cpp src/io/source/rosbag2_folder.cpp src/io/source/no_ros1_log.cpp
               src/io/source/bag_message.cpp src/io/source/bag_topics.cpp src/io/yaml_text.cpp src/io/file_bytes.cpp
               src/io/calibration_text.cpp src/io/frame_mat.cpp src/core/frame.cpp)
      libraries=($(pkg-config --cflags --libs opencv4 yaml-cpp sqlite3 libzstd liblz4 libtiff-4 zlib)) ;;
    track)
      sources=(src/io/geo/track_csv.cpp src/io/geo/track_nmea.cpp src/io/geo/track_srt.cpp src/io/geo/track_values.cpp
               src/io/geo/utc_time.cpp src/io/calibration_text.cpp)
      libraries=() ;;
    image)
      sources=(src/io/image_file.cpp src/io/{jpeg,png,tiff}_check.cpp src/io/tiff_decoding.cpp src/io/netpbm.cpp src/io/file_bytes.cpp src/io/frame_mat.cpp
               src/core/frame.cpp)
      libraries=($(pkg-config --cflags --libs opencv4 libtiff-4 zlib)) ;;
    trajectory) sources=(src/io/trajectory_file.cpp src/io/quaternion.cpp) libraries=() ;;
    *) echo "usage: $0 [request|journal|calibration|bag|track|image|trajectory|all] [SECONDS]" >&2; exit 2 ;;
  esac
  corpus=build-fuzz/corpus/$name
  mkdir -p "$corpus"
  echo "fuzz_$name"
  "${build[@]}" "tests/fuzz/fuzz_$name.cpp" "${main[@]}" "${sources[@]}" "${libraries[@]}" -o "build-fuzz/fuzz_$name"
  if [ ${#main[@]} -gt 0 ]; then
    "build-fuzz/fuzz_$name" "tests/fuzz/seeds/$name"
  else
    "build-fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=32768 -verbosity=0 \
      -print_final_stats=1 -artifact_prefix=build-fuzz/ "$corpus" "tests/fuzz/seeds/$name"
  fi
done
