#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// Writes ROS bags with ROS's own messages, whose headers do not compile as C++20: hence this header knows none of
/// them.
class BagWriter {
 public:
  explicit BagWriter(const std::string& file);
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  ~BagWriter();

  struct Picture {
    std::string encoding;
    int width = 0;
    int height = 0;
    int step = 0;
    bool big_endian = false;
    std::vector<std::uint8_t> data;
  };
  struct Camera {
    int width = 0;
    int height = 0;
    std::string distortion_model;
    std::vector<double> d;
    std::array<double, 9> k{};
    std::array<double, 9> r{};
    std::array<double, 12> p{};
  };

  /// `stamp_s` goes into the message, `received_s` into the bag, where messages are in that order.
  void write_image(const std::string& topic, double stamp_s, double received_s, const Picture& picture);
  void write_compressed(const std::string& topic, double stamp_s, double received_s, const std::string& format,
                        const std::vector<std::uint8_t>& bytes);
  void write_camera(const std::string& topic, double stamp_s, const Camera& camera);
  void close();

 private:
  struct Bag;
  std::unique_ptr<Bag> bag_;
};
