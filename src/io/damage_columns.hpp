#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "io/csv.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// One value of a damage; monostate: unknown. Numbers are finite.
using DamageValue = std::variant<std::monostate, std::int64_t, double, bool, std::string>;

/// One column of the damage tables.
struct DamageColumn {
  const char* name;
  DamageValue (*value)(const Damage& damage);
};

/// Returns all columns in order.
const std::vector<DamageColumn>& damage_columns();

/// Append the names of the columns, or the values of one damage, to a line. Unknown values are empty.
void add_damage_names(CsvLine& line);
void add_damage_cells(const Damage& damage, CsvLine& line);

}  // namespace roadstereo::io
