#pragma once

#include <optional>
#include <vector>

namespace roadstereo::cli {

/// What one link measures.
struct LinkValue {
  int reference;  ///< frame
  double value, sd;
};

struct LinkMean {
  double value, std_error;
};

/// Weighted mean over links. Links of one reference share its errors: they count as one in the standard error. Nothing
/// below ten references.
std::optional<LinkMean> mean_of_links(const std::vector<LinkValue>& links);

}  // namespace roadstereo::cli
