#include "evaluate/scan_model.hpp"

namespace roadstereo::cli {
namespace {

constexpr double side = 0.04;  // of the standard deviation along the longest axis: 0.8 mm of a hand's breadth

}  // namespace

ScanModel::ScanModel(const Points& points)
    : axes(main_axes(points)), scan(points), even(thin_out(points, side * axes.spread[0])), lies(even.lies()) {}

bool ScanModel::covers(const Eigen::Vector3d& point) const {
  return !lies[even.nearest(point).index].at_edge;
}

}  // namespace roadstereo::cli
