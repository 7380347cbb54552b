// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/joint_scene.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "common/errors.hpp"
#include "common/input/value.hpp"
#include "stage3_nonlinear/scene_check.hpp"

namespace fastjoint::stage3 {
namespace {

using input::Value;

constexpr int most_increments = 100000;
constexpr int most_iterations = 1000000;
/// Rounding sets the lower end; a joint known to less than the upper end is not solved.
constexpr input::Range tolerances{.low = 1e-14, .high = 1e-2};

std::string where(const std::string& file, const Value& value) { return fmt::format("{}: {}", file, value.pointer()); }

/// Splits at the first colon: the names of holes may hold colons, those of plates may not.
Reference read_reference(const std::string& file, const Value& value, const char* kind) {
  const std::string text = value.text();
  const auto colon = text.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size())
    value.not_allowed(fmt::format("\"plate:{}\"", kind));
  return {text.substr(0, colon), text.substr(colon + 1), where(file, value)};
}

std::vector<PlateScene> read_plates(const std::string& file, const Value& plates) {
  const auto folder = std::filesystem::path(file).parent_path();
  std::vector<PlateScene> result;
  for (const auto& [name, path] : plates.members()) {
    if (name.find_first_of(":/") != std::string::npos || name == ".")
      path.fail("name of a plate", "names without ':' and '/', other than \".\"");
    result.push_back({name, (folder / path.text()).string(), where(file, path)});
  }
  if (result.size() < 2) plates.fail(fmt::format("{} plate(s)", result.size()), "at least 2");
  return result;
}

void read_laws(const Value& laws, JointScene& scene) {
  for (const auto& [name, value] : laws.members()) {
    LawScene law{read_law(value), false};
    if (const auto one_sided = value.find("one_sided")) law.one_sided = one_sided->boolean();
    for (const auto& doubt : law.law->doubts())
      scene.warnings.push_back(fmt::format("{}: {}", where(scene.file, value), doubt));
    scene.laws.emplace(name, std::move(law));
  }
  if (scene.laws.empty()) laws.fail("no law", "at least one");
}

/// A number for both plates, or {"plate": mu} where a plate left out has none.
std::array<double, 2> read_friction(const Value& value, const std::array<Reference, 2>& between) {
  if (!value.is_object()) {
    const double mu = value.number(input::not_negative);
    return {mu, mu};
  }
  std::array<double, 2> friction{};
  for (const auto& [plate, mu] : value.members()) {
    if (plate != between[0].plate && plate != between[1].plate)
      mu.fail("not a plate of this fastener", fmt::format("{}, {}", between[0].plate, between[1].plate));
    friction[plate == between[0].plate ? 0 : 1] = mu.number(input::not_negative);
  }
  return friction;
}

FastenerScene read_fastener(const Value& value, const JointScene& scene) {
  value.only({"id", "between", "law", "clearance", "friction"});
  FastenerScene fastener;
  fastener.where = where(scene.file, value);
  fastener.id = value.at("id").text();
  const auto between = value.at("between").items(2, 2);
  for (const std::size_t end : {0U, 1U}) fastener.between[end] = read_reference(scene.file, between[end], "hole");
  std::vector<std::string> laws;
  laws.reserve(scene.laws.size());
  for (const auto& [name, law] : scene.laws) laws.push_back(name);
  fastener.law = value.at("law").choice(laws);
  if (const auto clearance = value.find("clearance")) fastener.clearance = clearance->number(input::not_negative);
  if (const auto friction = value.find("friction")) fastener.friction = read_friction(*friction, fastener.between);
  return fastener;
}

LoadScene read_load(const std::string& file, const Value& value) {
  value.only({"external", "force", "displacement"});
  LoadScene load;
  load.external = read_reference(file, value.at("external"), "external");
  const auto force = value.find("force");
  const auto displacement = value.find("displacement");
  if (force && displacement) value.fail("both \"force\" and \"displacement\"", "exactly one of them");
  if (force) {
    load.value = force->number();
  } else if (displacement) {
    load.value = displacement->number();
    load.is_displacement = true;
  } else {
    value.fail("neither \"force\" nor \"displacement\"", "exactly one of them");
  }
  return load;
}

std::vector<double> read_increments(const Value& value) {
  std::vector<double> factors;
  if (value.is_array()) {
    for (const auto& item : value.items(1, most_increments)) factors.push_back(item.number());
  } else {
    const int n = value.integer(1, most_increments);
    for (int i = 1; i <= n; ++i) factors.push_back(static_cast<double>(i) / n);
  }
  return factors;
}

InitialScene read_initial(const Value& value) {
  if (value.is_object()) {
    value.only({"linear"});
    return {Guess::linear, value.at("linear").number(input::positive)};
  }
  if (!value.is_string()) value.not_allowed("\"rigid\", \"equal\" or {\"linear\": stiffness}");
  return {value.choice({"rigid", "equal"}) == "rigid" ? Guess::rigid : Guess::equal, std::nullopt};
}

SolverScene read_solver(const Value& value) {
  value.only({"tolerance", "max_iterations"});
  SolverScene solver;
  if (const auto tolerance = value.find("tolerance")) solver.tolerance = tolerance->number(tolerances);
  if (const auto most = value.find("max_iterations")) solver.max_iterations = most->integer(1, most_iterations);
  return solver;
}

formats::Units read_units(const Value& value) {
  value.only({"length", "force"});
  return {value.at("length").text(), value.at("force").text()};
}

}  // namespace

JointScene read_joint_scene(const input::Document& document) {
  const Value root(document);
  input::check_format(root, "joint");
  root.only({"$schema", "format", "version", "name", "units", "plates", "laws", "fasteners", "loads", "increments",
             "initial", "solver"});
  JointScene scene;
  scene.file = document.file;
  if (const auto name = root.find("name")) scene.name = name->text();
  if (const auto units = root.find("units")) scene.units = read_units(*units);
  scene.plates = read_plates(scene.file, root.at("plates"));
  read_laws(root.at("laws"), scene);
  for (const auto& item : root.at("fasteners").items(1)) scene.fasteners.push_back(read_fastener(item, scene));
  for (const auto& item : root.at("loads").items(1)) scene.loads.push_back(read_load(scene.file, item));
  if (const auto increments = root.find("increments")) scene.load_factors = read_increments(*increments);
  if (const auto initial = root.find("initial")) scene.initial = read_initial(*initial);
  if (const auto solver = root.find("solver")) scene.solver = read_solver(*solver);
  check_scene(scene);
  return scene;
}

void refuse(const std::string& where, const std::string& found, const std::string& allowed) {
  throw InputError(fmt::format("{}: {}; allowed: {}", where, found, allowed));
}

}  // namespace fastjoint::stage3
