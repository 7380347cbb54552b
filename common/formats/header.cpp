// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/errors.hpp"

namespace fastjoint::formats {
std::string expected_unit(const Units& units, int length_power, int force_power) {
  return units.length.empty() || units.force.empty() ? "" : unit(units, length_power, force_power);
}

void write_header(h5::Writer& file, const Header& header) {
  const nlohmann::json units = {{"length", header.units.length}, {"force", header.units.force}};
  file.attribute("generator", header.generator);
  file.attribute("name", header.name);
  file.attribute("units", units.dump());
  file.write("input", header.input, {"1", "JSON text that this file came from"});
}

Header read_header(const h5::Reader& file) {
  Header header;
  header.generator = file.attribute("generator", "");
  header.name = file.attribute("name", "");
  if (file.has("input")) header.input = file.text("input");
  // A hand-made file may have no labels, or some of another form: then they are unknown.
  const auto units = nlohmann::json::parse(file.attribute("units", "{}"), nullptr, false);
  const auto label = [&](const char* key) -> std::string {
    return units.is_object() && units.contains(key) && units[key].is_string() ? units[key] : "";
  };
  header.units = {label("length"), label("force")};
  header.digest = file.digest();
  return header;
}

void check_words(const h5::Reader& file, const char* dataset, const std::vector<std::string>& words,
                 const std::vector<std::string>& allowed) {
  for (const auto& word : words)
    if (std::find(allowed.begin(), allowed.end(), word) == allowed.end())
      throw FileError(
          fmt::format("{}:{}: holds \"{}\", expected one of {}", file.path(), dataset, word, fmt::join(allowed, ", ")));
}

bool ascends(const Eigen::VectorXi& list) {
  return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end();
}

void check_degrees(const h5::Reader& file, const char* dataset, const Eigen::VectorXi& p, int highest) {
  if (p.size() == 0) throw FileError(fmt::format("{}:{}: holds no degree", file.path(), dataset));
  if (!ascends(p) || p[0] < 1 || p[p.size() - 1] > highest)
    throw FileError(fmt::format("{}:{}: is {}, expected ascending degrees from 1 to {}", file.path(), dataset,
                                fmt::join(p, ", "), highest));
}

void write_space(h5::Writer& file, pfem::Space space) { file.attribute("space", pfem::name_of(space)); }

pfem::Space read_space(const h5::Reader& file) {
  const std::string name = file.attribute("space", pfem::name_of(pfem::Space::trunk));
  const auto& names = pfem::space_names;
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw FileError(
        fmt::format("{}: attribute 'space' is '{}', expected one of {}", file.path(), name, fmt::join(names, ", ")));
  return pfem::space_named(name);
}

}  // namespace fastjoint::formats
