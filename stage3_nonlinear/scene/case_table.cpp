// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/case_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "common/count.hpp"
#include "common/input/csv.hpp"
#include "common/program/program.hpp"

namespace fastjoint::stage3 {
namespace {

/// The load that a column holds, without its value.
LoadScene load_of(const std::string& heading, const std::string& place, const std::vector<PlateScene>& plates) {
  LoadScene load;
  std::string name = heading;
  for (const auto& [kind, is] :
       {std::pair(" displacement", &LoadScene::is_displacement), {" moment", &LoadScene::is_moment}})
    if (name.ends_with(kind)) {
      name.resize(name.size() - std::string_view(kind).size());
      load.*is = true;
    }
  const auto plate =
      std::ranges::find_if(plates, [&](const PlateScene& each) { return name.starts_with(each.name + ":"); });
  if (plate == plates.end())
    refuse(place, fmt::format("column \"{}\"", heading),
           "\"case\", and \"plate:external\" of the joint's plates, with or without \" displacement\" or \" moment\"");
  load.external = {plate->name, name.substr(plate->name.size() + 1), fmt::format("{}: column \"{}\"", place, heading)};
  return load;
}

}  // namespace

std::vector<CaseScene> read_case_table(const std::string& path, const std::vector<PlateScene>& plates,
                                       const std::vector<double>& load_factors) {
  const auto rows = input::read_csv(path);
  if (rows.size() < 2) refuse(path, "no case", "a line of names, then a case in each line");
  const auto& headings = rows.front().cells;
  const std::string first = fmt::format("{}:{}", path, rows.front().line);
  const auto named = std::ranges::find(headings, "case") - headings.begin();
  if (named == std::ssize(headings)) refuse(first, "no column \"case\"", "one with the name of each case");
  std::vector<LoadScene> loads;
  std::set<std::string> loaded;
  for (std::ptrdiff_t at = 0; at < std::ssize(headings); ++at) {
    if (at == named) continue;
    if (headings[at] == "case") refuse(first, "a second column \"case\"", "one");
    const auto& external = loads.emplace_back(load_of(headings[at], first, plates)).external;
    if (!loaded.insert(external.plate + ":" + external.name).second)
      refuse(external.where, "a second column of this external", "one column for each external");
  }
  std::vector<CaseScene> cases;
  std::set<std::string> names;
  for (const auto& [line, cells] : std::span(rows).subspan(1)) {
    const std::string place = fmt::format("{}:{}", path, line);
    if (cells.size() != headings.size())
      refuse(place, fmt::format("{}, and {} of names", program::counted(cells.size(), "cell"), headings.size()),
             "as many cells as names, parted by the same character; '#' begins a comment unless it is quoted");
    CaseScene& its = cases.emplace_back(CaseScene{cells[named], loads, load_factors});
    its.where = its.where_loads = place;
    if (its.name.empty() || !names.insert(its.name).second)
      refuse(place, its.name.empty() ? "a case without a name" : fmt::format("\"{}\" stands twice", its.name),
             "each name once");
    for (std::ptrdiff_t at = 0, load = 0; at < std::ssize(headings); ++at)
      if (at != named)
        its.loads[load++].value = cells[at].empty() ? 0 : input::csv_value(cells[at], place, headings[at]);
  }
  return cases;
}

}  // namespace fastjoint::stage3
