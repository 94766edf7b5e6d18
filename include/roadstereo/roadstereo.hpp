#pragma once

// The embedded library in one include.

#include "roadstereo/alignment.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/cross_section.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/options.hpp"
#include "roadstereo/perspective.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/point_cloud.hpp"
#include "roadstereo/relief.hpp"
#include "roadstereo/resolution_limits.hpp"
#include "roadstereo/rig_bias.hpp"
#include "roadstereo/road_model.hpp"
#include "roadstereo/roll.hpp"
#include "roadstereo/series_smoother.hpp"
#include "roadstereo/version.hpp"
#include "roadstereo/warning.hpp"
