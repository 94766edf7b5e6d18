#pragma once

#include "inspection.hpp"

namespace roadstereo::cli {

/// Fills the result from the pair's disparity map instead of matching: road, roll and transformed map. The road is
/// found in the images if there is a right one, else in the map by RANSAC. There are no standard errors.
void use_given_disparity(Inspection& inspection);

}  // namespace roadstereo::cli
