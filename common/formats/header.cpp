// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

/// A hand-made file may have no labels, or some of another form: then they are unknown.
Units labels(const std::string& text) {
  const auto units = nlohmann::json::parse(text, nullptr, false);
  const auto label = [&](const char* key) -> std::string {
    return units.is_object() && units.contains(key) && units[key].is_string() ? units[key] : "";
  };
  return {label("length"), label("force")};
}

}  // namespace

template <class File, class AnyHeader>
void header(File& file, AnyHeader& a) {
  file.attribute("generator", a.generator);
  file.attribute("name", a.name);
  std::string units = nlohmann::json({{"length", a.units.length}, {"force", a.units.force}}).dump();
  file.attribute("units", units);
  if constexpr (File::reads) {
    a.digest = file.digest();
    a.units = labels(units);
    file.compare_units(!a.units.length.empty() && !a.units.force.empty());
  }
  file("input", a.input, {}, "1", "JSON text that this file came from", h5::or_else(""));
}
template void header(h5::Writer& file, const Header& a);
template void header(h5::Reader& file, Header& a);

template <class File, class AnySpace>
void space(File& file, AnySpace& a) {
  std::string name = pfem::name_of(a);
  file.attribute("space", name);
  if constexpr (File::reads) {
    const auto& names = pfem::space_names;
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw FileError(
          fmt::format("{}: attribute 'space' is '{}', expected one of {}", file.path(), name, fmt::join(names, ", ")));
    a = pfem::space_named(name);
  }
}
template void space(h5::Writer& file, const pfem::Space& a);
template void space(h5::Reader& file, pfem::Space& a);

h5::Allowed degrees(int highest) {
  return {.text = fmt::format("ascending degrees from 1 to {}", highest), .low = 1, .high = double(highest), .step = 1};
}

}  // namespace fastjoint::formats
