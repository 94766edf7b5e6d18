#include "core/parallel.hpp"
#include "road/off_road/cell_map.hpp"
#include "road/off_road/consistency.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/off_road.hpp"

namespace roadstereo {
namespace {

constexpr int band_rows = 8;  // of cells

void compare_cells(const CoarseScene& scene, ImageView<const float> disparity, int threads,
                   CellMap<CellEvidence>& evidence, CellMap<CellState>& states) {
  parallel_rows(states.rows, band_rows, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      for (int i = 0; i < states.columns; ++i) {
        evidence(i, j) = assess_consistency(scene, cell_residual(disparity, scene.shift, i, j), i, j);
        states(i, j) = evidence(i, j) == CellEvidence::on_road ? confirmed : unconfirmed;
      }
    }
  });
}

}  // namespace

void reject_inconsistent(const DisparityPriorView& coarse, const PerspectiveShift& shift, int threads,
                         Image<float>& disparity, Image<float>& sigma) {
  require_equal_sizes(disparity, sigma);
  const int width = disparity.width(), height = disparity.height();
  if (coarse.factor < alignment_cell || coarse.disparity.width() != width / coarse.factor ||
      coarse.disparity.height() != height / coarse.factor) {
    fail("the coarse map has ", coarse.disparity.width(), "×", coarse.disparity.height(), " pixels of ", coarse.factor,
         "; a map of ", width, "×", height, " pixels needs ⌊W/s⌋×⌊H/s⌋ of s, 4 or more");
  }
  const int columns = alignment_cells(width), rows = alignment_cells(height);
  CellMap<CellEvidence> evidence(columns, rows);
  CellMap<CellState> states(columns, rows);
  compare_cells({coarse.disparity, coarse.factor, shift}, disparity, threads, evidence, states);
  connect_with_border(states);
  reject_cells(
      columns, rows, threads, [&](int i, int j) { return is_contradicted(evidence, states, i, j, columns, rows); },
      disparity, sigma);
}

}  // namespace roadstereo
