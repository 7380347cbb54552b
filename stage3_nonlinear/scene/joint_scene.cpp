// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/joint_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <ranges>
#include <set>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/program/program.hpp"
#include "stage3_nonlinear/scene/case_table.hpp"

namespace fastjoint::stage3 {
namespace {

using input::Value;

constexpr int max_increments = 100000;
/// The lower end is set by rounding; above the upper end a joint would not count as solved.

std::string where(const Value& value) { return fmt::format("{}: {}", value.file(), value.pointer()); }

/// Names of all items, "a, b".
template <class Item>
std::string listed(const std::vector<Item>& items, std::string Item::*name) {
  return fmt::format("{}", fmt::join(items | std::views::transform(name), ", "));
}

/// Reads "plate:name", split at the first colon: the names of holes may contain colons, those of plates may not.
Reference read_reference(const Value& value, const JointScene& scene, const char* allowed) {
  const std::string text = value.text();
  const auto colon = text.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) value.not_allowed(allowed);
  Reference result{text.substr(0, colon), text.substr(colon + 1), where(value)};
  if (index_of(scene.plates, result.plate, &PlateScene::name) == count_of(scene.plates))
    value.fail(fmt::format("plate \"{}\" does not exist", result.plate), listed(scene.plates, &PlateScene::name));
  return result;
}

std::vector<PlateScene> read_plates(const Value& plates) {
  const auto folder = std::filesystem::path(plates.file()).parent_path();
  std::vector<PlateScene> result;
  for (const auto& [name, plate] : plates.members()) {
    if (name.find_first_of(":/") != std::string::npos || name == "." || name == ground_name)
      plate.fail("name of a plate", "names without ':' and '/', other than \".\" and \"ground\"");
    if (plate.is_object()) plate.only({"file", "digest"});
    const Value path = plate.is_object() ? plate.at("file") : plate;
    const auto digest = plate.is_object() ? plate.find("digest") : std::nullopt;
    result.push_back({name, (folder / path.text()).string(), where(plate), digest ? digest->text() : ""});
  }
  if (result.empty()) plates.fail("no plate", "at least one");
  return result;
}

std::map<std::string, LawScene> read_laws(const Value& laws) {
  std::map<std::string, LawScene> result;
  for (const auto& [name, value] : laws.members()) {
    const auto one_sided = value.find("one_sided");
    result.emplace(name, LawScene{read_law(value), one_sided && one_sided->boolean()});
  }
  return result;
}

/// Warnings about the laws of fasteners.
std::vector<program::Warning> law_doubts(const Value& laws, const JointScene& scene) {
  std::set<std::string> used;
  for (const auto& fastener : scene.fasteners) used.insert(fastener.law.begin(), fastener.law.end());
  std::vector<program::Warning> doubts;
  for (const auto& name : used)
    for (const auto& doubt : scene.laws.at(name).law->doubts())
      doubts.push_back({doubt.code, fmt::format("{}: {}", where(laws.at(name.c_str())), doubt.text)});
  return doubts;
}

/// Reads a number for all holes, or {"plate": mu}, in which a missing plate has no friction.
std::vector<double> read_friction(const Value& value, const std::vector<Reference>& between) {
  if (!value.is_object()) return std::vector<double>(between.size(), value.number(input::not_negative));
  std::vector<double> friction(between.size(), 0.0);
  for (const auto& [plate, mu] : value.members()) {
    const int hole = index_of(between, plate, &Reference::plate);
    if (hole == count_of(between)) mu.fail("not a plate of this fastener", listed(between, &Reference::plate));
    friction[hole] = mu.number(input::not_negative);
  }
  return friction;
}

/// Reads one value for all of n shear planes or holes, or a list with one for each.
template <class Read>
auto for_each_of(const Value& value, std::size_t n, Read read) {
  if (!value.is_array()) return std::vector(n, read(value));
  std::vector<decltype(read(value))> result;
  for (const auto& item : value.items(n, n)) result.push_back(read(item));
  return result;
}

/// Reads gaps, or the diameters from which they follow.
void read_gaps(const Value& value, FastenerScene& fastener) {
  const auto gap = value.find("gap"), diameter = value.find("diameter"), of_holes = value.find("hole_diameter");
  if (const auto& given = gap ? gap : diameter; given && value.find("clearance"))
    given->fail("given together with \"clearance\"", "one of them");
  if (gap && diameter) diameter->fail("given together with \"gap\"", "one of them");
  if (of_holes && !diameter) of_holes->fail("given without \"diameter\"", "both, or \"gap\"");
  const std::size_t n = fastener.between.size();
  if (gap) fastener.gap = for_each_of(*gap, n, [](const Value& each) { return each.number(); });
  if (diameter) fastener.diameter = diameter->number(input::positive);
  if (of_holes)
    fastener.hole_diameter = for_each_of(*of_holes, n, [](const Value& each) { return each.number(input::positive); });
}

/// Reads {"plate": [x, y], ...}: where holes are off.
void read_offset(const Value& value, FastenerScene& fastener) {
  for (const auto& [plate, offset] : value.members()) {
    const auto found = std::ranges::find(fastener.between, plate, &Reference::plate);
    if (found == fastener.between.end())
      offset.fail("not a plate of this fastener", listed(fastener.between, &Reference::plate));
    const auto xy = offset.numbers(2, 2, input::any_number);
    fastener.offset[found - fastener.between.begin()] = {xy[0], xy[1]};
  }
}

FastenerScene read_fastener(const Value& value, const JointScene& scene) {
  value.only({"id", "between", "law", "clearance", "friction", "law_includes_friction", "gap", "diameter",
              "hole_diameter", "offset", "expansion"});
  FastenerScene fastener;
  fastener.where = where(value);
  fastener.id = value.at("id").text();
  auto between = value.at("between").items(2);
  fastener.grounded = between.back().is_string() && between.back().text() == ground_name;
  const std::size_t n_planes = between.size() - 1;
  if (fastener.grounded) between.pop_back();
  for (const auto& hole : between)
    fastener.between.push_back(read_reference(hole, scene, R"("plate:hole", or "ground" as the last)"));
  std::vector<std::string> laws;
  for (const auto& [name, law] : scene.laws) laws.push_back(name);
  fastener.law = for_each_of(value.at("law"), n_planes, [&](const Value& law) { return law.choice(laws); });
  fastener.clearance.assign(n_planes, 0.0);
  if (const auto clearance = value.find("clearance"))
    fastener.clearance =
        for_each_of(*clearance, n_planes, [](const Value& gap) { return gap.number(input::not_negative); });
  read_gaps(value, fastener);
  fastener.friction.assign(fastener.between.size(), 0.0);
  if (const auto friction = value.find("friction")) fastener.friction = read_friction(*friction, fastener.between);
  fastener.offset.assign(fastener.between.size(), {0, 0});
  if (const auto offset = value.find("offset")) read_offset(*offset, fastener);
  if (const auto expansion = value.find("expansion")) fastener.expansion = expansion->number();
  if (const auto includes = value.find("law_includes_friction")) fastener.law_includes_friction = includes->boolean();
  return fastener;
}

/// Reads all fasteners; ids are unique, and each hole has one fastener, which goes through each plate once. Sheets may
/// be alone, all of them.
void read_fasteners(const Value& fasteners, JointScene& scene) {
  std::set<std::string> ids, used, fastened;
  for (const auto& value : fasteners.items()) {
    const FastenerScene& fastener = scene.fasteners.emplace_back(read_fastener(value, scene));
    if (!ids.insert(fastener.id).second)
      value.at("id").fail(fmt::format("\"{}\" stands twice", fastener.id), "each id once");
    std::set<std::string> plates;
    for (const auto& hole : fastener.between) {
      const std::string name = hole.plate + ":" + hole.name;
      if (!used.insert(name).second)
        refuse(hole.where, fmt::format("hole \"{}\" has a fastener already", name), "one fastener per hole");
      if (!plates.insert(hole.plate).second)
        value.at("between").fail(fmt::format("goes through plate \"{}\" twice", hole.plate),
                                 "holes of different plates");
    }
    fastened.merge(plates);
  }
  for (const auto& plate : scene.plates)
    if (!scene.fasteners.empty() && !fastened.contains(plate.name))
      refuse(plate.where, "this plate has no fastener",
             "plates that a fastener names in \"between\", or no fasteners at all");
}

LoadScene read_load(const Value& value, const JointScene& scene) {
  value.only({"external", "force", "displacement", "moment"});
  const Value external = value.at("external");
  constexpr const char* allowed = "\"plate:external\", or a list of such that are tied";
  LoadScene load;
  if (external.is_array()) {
    for (const auto& item : external.items(2)) load.tied.push_back(read_reference(item, scene, allowed));
    load.external = load.tied.front();
    load.tied.erase(load.tied.begin());
  } else {
    load.external = read_reference(external, scene, allowed);
  }
  std::vector<std::pair<std::string, Value>> given;
  for (const char* key : {"force", "displacement", "moment"})
    if (const auto number = value.find(key)) given.emplace_back(key, *number);
  if (given.size() != 1)
    value.fail(
        fmt::format("{} of \"force\", \"displacement\" and \"moment\"", given.empty() ? "none" : "more than one"),
        "exactly one of them");
  const auto& [kind, number] = given.front();
  load.is_displacement = kind == "displacement";
  load.is_moment = kind == "moment";
  if (kind != "force" && !load.tied.empty())
    number.fail("given for tied externals", "\"force\", or a load of its own for each external");
  load.value = number.number();
  return load;
}

/// @param least Least number of loads.
std::vector<LoadScene> read_loads(const Value& value, const JointScene& scene, std::size_t least) {
  std::vector<LoadScene> loads;
  std::set<std::string> loaded;
  for (const auto& item : value.items(least)) {
    const LoadScene load = read_load(item, scene);
    std::vector<Reference> all = load.tied;
    all.push_back(load.external);
    for (const auto& external : all)
      if (!loaded.insert(external.plate + ":" + external.name).second)
        refuse(external.where, fmt::format("\"{}:{}\" is loaded already", external.plate, external.name),
               "one load per external boundary");
    loads.push_back(load);
  }
  return loads;
}

/// Load factors of the increments; none for "events".
std::vector<double> read_increments(const Value& value) {
  std::vector<double> factors;
  if (value.is_array()) {
    for (const auto& item : value.items(1, max_increments)) factors.push_back(item.number());
  } else if (value.is_number()) {
    const int n = value.integer(1, max_increments);
    for (int i = 1; i <= n; ++i) factors.push_back(double(i) / n);
  } else if (!value.is_string() || value.text() != "events") {
    value.not_allowed(fmt::format("an integer from 1 to {}, a list of load factors, or \"events\"", max_increments));
  }
  return factors;
}

/// Reads temperatures, of plates by name and of the fasteners, into a case.
void read_temperatures(const Value& item, const JointScene& scene, CaseScene& its) {
  if (const auto temperatures = item.find("temperatures"))
    for (const auto& [plate, value] : temperatures->members()) {
      if (std::ranges::find(scene.plates, plate, &PlateScene::name) == scene.plates.end())
        value.fail("no plate has this name", listed(scene.plates, &PlateScene::name));
      its.temperature[plate] = value.number();
    }
  if (const auto fasteners = item.find("fastener_temperature")) its.fastener_temperature = fasteners->number();
}

/// Sets the case that each follows; none may follow itself, over whatever others.
void read_order(const std::vector<Value>& items, std::vector<CaseScene>& cases) {
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (const auto after = items[i].find("after")) {
      const auto found = std::ranges::find(cases, after->text(), &CaseScene::name);
      if (found == cases.end())
        after->fail(fmt::format("\"{}\" is no case", after->text()), listed(cases, &CaseScene::name));
      cases[i].after = found - cases.begin();
    }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::size_t n_before = 0;
    for (auto at = cases[i].after; at; at = cases[*at].after)
      if (++n_before > cases.size())
        items[i].at("after").fail(fmt::format("\"{}\" comes after itself", cases[i].name),
                                  "cases that lead back to the unloaded joint");
    for (auto at = cases[i].after; at; at = cases[*at].after) {  // temperatures stay unless they change
      cases[i].temperature.insert(cases[*at].temperature.begin(), cases[*at].temperature.end());
      if (!cases[i].fastener_temperature) cases[i].fastener_temperature = cases[*at].fastener_temperature;
    }
    if (cases[i].after && cases[i].held() != cases[*cases[i].after].held())
      items[i].at("loads").fail(fmt::format("displaces or ties other externals than \"{}\", after which it comes",
                                            cases[*cases[i].after].name),
                                "the same ties, and displacements of the same externals, 0 where one is to stay");
  }
}

/// Reads "cases", or the one case that "loads" and "increments" make.
std::vector<CaseScene> read_cases(const Value& root, const JointScene& scene) {
  const auto increments = root.find("increments"), given = root.find("cases");
  const std::vector<double> factors = increments ? read_increments(*increments) : std::vector{1.0};
  for (const char* key : {"temperatures", "fastener_temperature", "loads"})
    if (const auto own = root.find(key); own && given)
      own->fail("given together with \"cases\"", key == std::string("loads") ? "one of them" : "it in each case");
  if (given && given->is_object()) {
    given->only({"table"});
    const auto folder = std::filesystem::path(root.file()).parent_path();
    return read_case_table((folder / given->at("table").text()).string(), scene.plates, factors);
  }
  std::vector<CaseScene> cases;
  std::set<std::string> names;
  const auto items = given ? given->items(1) : std::vector{root};
  for (const auto& item : items) {
    if (given) item.only({"name", "loads", "increments", "after", "temperatures", "fastener_temperature"});
    const auto own = item.find("increments");
    CaseScene& its = cases.emplace_back(CaseScene{given ? item.at("name").text() : "",
                                                  read_loads(item.at("loads"), scene, given ? 0 : 1),
                                                  own ? read_increments(*own) : factors});
    its.where = where(item);
    its.where_loads = where(item.at("loads"));
    read_temperatures(item, scene, its);
    if (!names.insert(its.name).second)
      item.at("name").fail(fmt::format("\"{}\" stands twice", its.name), "each name once");
  }
  read_order(items, cases);
  const bool remembers =
      std::ranges::any_of(scene.laws, [](const auto& each) { return each.second.law && each.second.law->remembers(); });
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (remembers && cases[i].after && cases[i].load_factors.empty())
      refuse(where(items[i]) + "/increments",
             fmt::format("\"events\" after \"{}\", in which fasteners may have yielded or slipped, so that they do so "
                         "at other loads now",
                         cases[*cases[i].after].name),
             "a number of increments, a list of load factors, or laws with \"reversible\": true");
  return cases;
}

/// Warns if fasteners without an expansion have a temperature, which then does nothing.
void warn_of_expansion(JointScene& scene) {
  const auto is_warm = [](const CaseScene& its) { return its.fastener_temperature.value_or(0) != 0; };
  if (std::ranges::none_of(scene.cases, is_warm)) return;
  std::vector<std::string> without;
  for (const auto& fastener : scene.fasteners)
    if (!fastener.expansion) without.push_back(fastener.id);
  if (without.empty()) return;
  scene.warnings.push_back(
      {"expansion-missing",
       fmt::format("{}: \"fastener_temperature\" does nothing at {}: give the fasteners their \"expansion\"",
                   scene.file, program::listed(without))});
}

}  // namespace

std::set<std::string> CaseScene::held() const {
  std::set<std::string> names;
  const auto full_name = [](const Reference& external) { return external.plate + ":" + external.name; };
  for (const auto& load : loads) {
    if (load.is_displacement) names.insert(full_name(load.external));
    for (const auto& tied : load.tied) names.insert(full_name(load.external) + " to " + full_name(tied));
  }
  return names;
}

JointScene read_joint_scene(const input::Document& document) {
  const Value root(document);
  input::check_format(root, "joint");
  root.only({"$schema", "format", "version", "name", "units", "plates", "laws", "fasteners", "loads", "temperatures",
             "fastener_temperature", "increments", "cases", "initial", "solver", "margins", "bending"});
  JointScene scene;
  scene.file = document.file;
  if (const auto name = root.find("name")) scene.name = name->text();
  if (const auto units = root.find("units"))
    scene.units = Units{units->only({"length", "force"}).at("length").text(), units->at("force").text()};
  scene.plates = read_plates(root.at("plates"));
  scene.laws = read_laws(root.at("laws"));
  read_fasteners(root.at("fasteners"), scene);
  scene.warnings = law_doubts(root.at("laws"), scene);
  scene.cases = read_cases(root, scene);
  warn_of_expansion(scene);
  std::vector<std::string> cases;
  for (const auto& its : scene.cases)
    if (!its.name.empty()) cases.push_back(its.name);
  if (const auto margins = root.find("margins")) scene.checks = read_margins(*margins, cases);
  if (const auto bending = root.find("bending")) scene.bending = read_bending(*bending, scene.plates);
  if (const auto initial = root.find("initial")) scene.initial = read_initial(*initial);
  if (const auto solver = root.find("solver")) scene.solver = read_solver(*solver);
  return scene;
}

void read_again(const input::Document& document, const std::set<std::vector<std::string>>& items, JointScene& scene) {
  const Value root(document);
  std::vector<Value> fasteners;  // read where some vary
  for (const auto& item : items) {
    const std::string& list = item.front();
    if (list == "laws") {
      scene.laws.at(item[1]).law = read_law(root.at("laws").at(item[1].c_str()));
    } else if (list == "fasteners") {
      if (fasteners.empty()) fasteners = root.at("fasteners").items();
      scene.fasteners[std::stoul(item[1])] = read_fastener(fasteners[std::stoul(item[1])], scene);
    } else {
      const std::size_t of_case = list == "cases" ? std::stoul(item[1]) : 0, at = std::stoul(item.back());
      const Value its = list == "cases" ? root.at("cases").items()[of_case] : root;
      scene.cases[of_case].loads[at] = read_load(its.at("loads").items()[at], scene);
    }
  }
}

void refuse(const std::string& where, const std::string& found, const std::string& allowed) {
  throw InputError(fmt::format("{}: {}; allowed: {}", where, found, allowed));
}

}  // namespace fastjoint::stage3
