#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "io/csv.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// One figure of a damage; monostate when it is not known. Numbers are finite.
using DamageValue = std::variant<std::monostate, std::int64_t, double, bool, std::string>;

/// One column of the tables of damages.
struct DamageColumn {
  const char* name;
  DamageValue (*value)(const Damage& damage);
};

/// All of them, in their order.
const std::vector<DamageColumn>& damage_columns();

/// Their names, and their values of one damage, as cells of a line. What is not known is empty.
void add_damage_names(CsvLine& line);
void add_damage_cells(const Damage& damage, CsvLine& line);

}  // namespace roadstereo::io
