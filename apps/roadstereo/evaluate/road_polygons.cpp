#include "evaluate/road_polygons.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

constexpr double max_coordinate = 100000;

std::array<double, 2> read_corner(const std::string& where, const nlohmann::json& corner) {
  const bool numbers = corner.is_array() && corner.size() == 2 && corner[0].is_number() && corner[1].is_number();
  if (!numbers) fail(where, ": a corner is ", corner.dump(), "; it must be two numbers, [u, v]");
  const std::array<double, 2> point{corner[0].get<double>(), corner[1].get<double>()};
  if (!(std::abs(point[0]) <= max_coordinate && std::abs(point[1]) <= max_coordinate)) {
    fail(where, ": a corner is ", corner.dump(), "; it must be within ±", max_coordinate, " px");
  }
  return point;
}

Polygon read_polygon(const std::string& where, const nlohmann::json& corners) {
  if (!corners.is_array() || corners.size() < 3) {
    fail(where, ": a polygon must be a list of at least three corners [u, v]");
  }
  Polygon polygon;
  for (const nlohmann::json& corner : corners) polygon.push_back(read_corner(where, corner));
  return polygon;
}

}  // namespace

std::map<std::string, std::vector<Polygon>> read_road_polygons(const std::string& path) {
  std::ifstream file(path);
  if (!file) fail("cannot read ", path);
  const nlohmann::json document = nlohmann::json::parse(file, nullptr, false);
  if (!document.is_object()) fail(path, ": this is not a JSON object of polygons by frame");
  std::map<std::string, std::vector<Polygon>> frames;
  for (const auto& [frame, polygons] : document.items()) {
    const std::string where = std::string(path).append(": ").append(frame);
    if (!polygons.is_array()) fail(where, ": the value must be a list of polygons");
    for (const nlohmann::json& corners : polygons) frames[frame].push_back(read_polygon(where, corners));
  }
  return frames;
}

}  // namespace roadstereo::cli
