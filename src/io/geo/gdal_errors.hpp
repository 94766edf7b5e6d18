#pragma once

#include <cpl_error.h>

#include <string>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::io {

/// Collects GDAL's errors of this thread during its lifetime instead of printing them.
class GdalErrors {
 public:
  /// `what` is written, e.g. a file.
  explicit GdalErrors(std::string what = "the GeoPackage") : what_(std::move(what)) {
    CPLPushErrorHandlerEx(&GdalErrors::collect, this);
  }
  ~GdalErrors() { CPLPopErrorHandler(); }
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  /// Throws SystemError with GDAL's first message if `done` is false or an error occurred.
  void require(bool done, const char* what) const {
    if (done && first_.empty()) return;
    fail<SystemError>("cannot write ", what_, ": ", what,
                      " failed: ", first_.empty() ? "no message from GDAL" : first_);
  }

 private:
  static void CPL_STDCALL collect(CPLErr kind, CPLErrorNum /*number*/, const char* text) {
    auto& errors = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (kind >= CE_Failure && errors.first_.empty()) errors.first_ = text;
  }

  std::string what_;
  std::string first_;
};

}  // namespace roadstereo::io
