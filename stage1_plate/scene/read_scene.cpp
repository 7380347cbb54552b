// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "common/errors.hpp"
#include "stage1_plate/scene/read_parts.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;

rim::Axis read_axis(const Value& value) { return rim::axis_named(value.choice(rim::axis_names)); }

/// Reads a name that must be unique, since other files refer to it.
std::string read_new_name(const Value& value, std::set<std::string>& seen) {
  std::string name = value.text();
  if (!seen.insert(name).second) value.fail(fmt::format("\"{}\" stands twice", name), "each name once");
  return name;
}

std::vector<rim::Axis> read_directions(const Value& value) {
  std::vector<rim::Axis> result;
  for (const auto& item : value.items(1, 2)) {
    result.push_back(read_axis(item));
    if (result.size() == 2 && result[0] == result[1])
      item.fail("\"" + rim::name_of(result[1]) + "\" stands twice", "each direction once");
  }
  return result;
}

Units read_units(const Value& root) {
  const auto units = root.find("units");
  if (!units) return {};
  units->only({"length", "force"});
  return {units->at("length").text(), units->at("force").text()};
}

std::vector<Hole> read_holes(const Value& root, bool is_grid, std::set<std::string>& ids) {
  const pfem::Analysis analysis = read_analysis(root);
  std::vector<Hole> holes;
  for (const auto& item : read_items(root, "holes")) {
    item.only({"id", "center", "radius", "spring", "rings", "waves", "stresses"});
    Hole hole;
    hole.id = read_new_name(item.at("id"), ids);
    hole.center = read_point(item.at("center"));
    hole.radius = read_quantity(item.at("radius"));
    if (const auto spring = item.find("spring")) hole.spring = read_spring(*spring, hole.radius, analysis);
    constexpr int max_rings = 20;
    const auto rings = item.find("rings");
    if (rings && !is_grid) rings->fail("extra rings in an explicit mesh", "\"rings\" with a grid only");
    hole.has_rings = rings.has_value();
    if (const auto waves = item.find("waves")) hole.waves = waves->integer(1, rim::max_harmonics);
    if (const auto stresses = item.find("stresses")) hole.stresses = stresses->boolean();
    hole.rings = rings ? rings->integer(0, max_rings) : 0;
    holes.push_back(std::move(hole));
  }
  return holes;
}

/// Refuses a thickness of the sheet that is not that of its laminate, and notes laminates that bend as they stretch.
void check_laminates(const Value& root, const std::vector<Material>& materials, PlateScene& scene) {
  constexpr double same = 1e-6, rounding = 1e-9;
  const auto check = [&](int material, double thickness) {
    const auto& [id, elasticity, expansion, stack, coupling, in_bending] = materials[material];
    if (stack > 0 && std::abs(thickness - stack) > same * stack)
      root.at("geometry")
          .fail(fmt::format("the thickness {:g} of the material \"{}\"", thickness, id),
                fmt::format("{:.9g}, the sum of its plies", stack));
  };
  if (const auto* grid = std::get_if<GridGeometry>(&scene.geometry)) {
    for (Eigen::Index i = 0; i < grid->material.size(); ++i)
      check(grid->material.reshaped()[i], grid->thickness.reshaped()[i]);
  } else {
    const auto& mesh = std::get<MeshGeometry>(scene.geometry).mesh;
    for (int i = 0; i < mesh.n_elements(); ++i) check(mesh.material[i], mesh.thickness[i]);
  }
  for (const auto& each : materials)
    if (each.coupling > rounding) scene.coupled_laminates.push_back(each.id);
}

/// Ratio of the maximum to the minimum modulus in tension over all directions in the plane.
double modulus_ratio(const Eigen::Matrix3d& elasticity) {
  const Eigen::Matrix3d compliance = elasticity.inverse();
  double min = std::numeric_limits<double>::infinity(), max = 0;
  constexpr int n_angles = 36;
  for (int i = 0; i < n_angles; ++i) {
    const double c = std::cos(std::numbers::pi * i / n_angles), s = std::sin(std::numbers::pi * i / n_angles);
    const Eigen::Vector3d stress(c * c, s * s, c * s);
    const double flexibility = stress.dot(compliance * stress);
    min = std::min(min, flexibility);
    max = std::max(max, flexibility);
  }
  return max / min;
}

/// Sets the number of rings where the scene does not: it keeps the ratio of radii of each ring moderate, and smaller
/// for anisotropic sheets, whose fields vary faster close to the rim. Holes in contact have at least one; without
/// stresses there are none.
void set_default_rings(const GridGeometry& grid, PlateScene& scene) {
  constexpr double isotropic_ratio = 3.2, min_ratio = 1.6;
  constexpr int max_rings = 6;
  double ratio = 1;
  for (const auto& elasticity : scene.elasticity) ratio = std::max(ratio, modulus_ratio(elasticity));
  const double step = std::log(std::max(isotropic_ratio / std::pow(ratio, 0.25), min_ratio));
  for (Hole& hole : scene.holes) {
    if (hole.has_rings) continue;
    const bool in_contact = hole.spring && hole.spring->compression_only;
    double reach = hole.radius;  // distance to the farthest side of its cell
    for (const int axis : {0, 1}) {
      const auto& lines = axis == 0 ? grid.x : grid.y;
      const auto above = std::upper_bound(lines.begin(), lines.end(), hole.center[axis]);
      if (above != lines.end()) reach = std::max(reach, *above - hole.center[axis]);
      const auto below = std::lower_bound(lines.begin(), lines.end(), hole.center[axis]);
      if (below != lines.begin()) reach = std::max(reach, hole.center[axis] - below[-1]);
    }
    const int wanted = hole.stresses ? static_cast<int>(std::ceil(std::log(reach / hole.radius) / step)) - 1 : 0;
    hole.rings = std::clamp(wanted, in_contact ? 1 : 0, max_rings);
  }
}

std::vector<PointSpring> read_points(const Value& root, std::set<std::string>& ids) {
  std::vector<PointSpring> points;
  for (const auto& item : read_items(root, "points")) {
    item.only({"id", "at", "stiffness"});
    points.push_back({read_new_name(item.at("id"), ids), read_point(item.at("at")),
                      read_quantity(item.at("stiffness"), softest_spring)});
  }
  return points;
}

std::vector<Support> read_supports(const Value& root, const std::vector<std::string>& edge_names) {
  std::vector<Support> supports;
  for (const auto& item : read_items(root, "supports")) {
    item.only({"on", "fix"});
    supports.push_back({item.at("on").choice(edge_names), read_directions(item.at("fix"))});
  }
  return supports;
}

/// Reads the id of an open hole.
std::string read_bearing_hole(const Value& value, const std::vector<Hole>& holes) {
  const Hole& hole = holes[read_id(value, holes)];
  if (hole.spring)
    value.fail(fmt::format("hole \"{}\" has springs, which transmit its load", hole.id), "a hole without \"spring\"");
  return hole.id;
}

std::vector<External> read_externals(const Value& root, const std::vector<std::string>& edge_names,
                                     const std::vector<Hole>& holes) {
  const std::map<std::string, ExternalKind> kinds = {{"rigid", ExternalKind::rigid},
                                                     {"traction", ExternalKind::traction},
                                                     {"bearing", ExternalKind::bearing},
                                                     {"moment", ExternalKind::moment}};
  std::vector<External> externals;
  std::set<std::string> ids;
  for (const auto& item : read_items(root, "external")) {
    item.only({"id", "on", "direction", "kind"});
    const ExternalKind kind = kinds.at(item.at("kind").choice({"rigid", "traction", "bearing", "moment"}));
    if (const auto direction = item.find("direction"); direction && kind == ExternalKind::moment)
      direction->fail("given for a moment, which turns", "an external of kind \"moment\" without \"direction\"");
    const Value on = item.at("on");
    externals.push_back({read_new_name(item.at("id"), ids),
                         kind == ExternalKind::bearing ? read_bearing_hole(on, holes) : on.choice(edge_names),
                         kind == ExternalKind::moment ? rim::Axis::x : read_axis(item.at("direction")), kind});
  }
  return externals;
}

void read_p(const Value& root, PlateScene& scene) {
  const auto p = root.find("p");
  if (!p) return;
  const auto range = p->is_array() ? p->items(2, 2) : std::vector{*p, *p};
  scene.p_low = range[0].integer(1, pfem::highest_p);
  scene.p_high = range[1].integer(scene.p_low, pfem::highest_p);
}

/// Names of the edges that can be held or loaded, which those of cracks cannot.
std::vector<std::string> edge_names(const PlateScene& scene) {
  if (std::holds_alternative<GridGeometry>(scene.geometry)) return {"left", "right", "bottom", "top"};
  std::vector<std::string> names;
  for (const auto& [name, edges] : std::get<MeshGeometry>(scene.geometry).edges)
    if (std::ranges::find(scene.cracks, name, &Crack::on) == scene.cracks.end()) names.push_back(name);
  return names;
}

/// Parses the whole text as an integer; 0 if it is not one.
int degree(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

}  // namespace

double read_quantity(const Value& value, double low) {
  const double x = value.number(input::positive);
  if (x < low || x > largest) value.not_allowed(fmt::format("{:g} to {:g}, in other units", low, largest));
  return x;
}

double read_coordinate(const Value& value) {
  const double x = value.number();
  if (std::abs(x) > largest) value.not_allowed(fmt::format("{:g} to {:g}, in other units", -largest, largest));
  return x;
}

Eigen::Vector2d read_point(const Value& value) {
  const auto xy = value.items(2, 2);
  return {read_coordinate(xy[0]), read_coordinate(xy[1])};
}

std::vector<Value> read_items(const Value& value, const char* key) {
  const auto list = value.find(key);
  return list ? list->items() : std::vector<Value>{};
}

PlateScene read_scene(const input::Document& document) {
  const Value root(document);
  if (const auto loads = root.find("loads")) loads->fail("unknown key", "\"loads\" in JOINT.json");
  root.only({"$schema", "format", "version", "name", "units", "analysis", "materials", "geometry", "holes", "points",
             "cracks", "disc_directions", "supports", "external", "space", "p"});
  input::check_format(root, "plate");
  PlateScene scene;
  scene.file = document.file;
  scene.text = document.text;
  if (const auto name = root.find("name")) scene.name = name->text();
  scene.units = read_units(root);
  const auto materials = read_materials(root);
  for (const auto& each : materials) scene.elasticity.push_back(each.elasticity);
  if (read_analysis(root) == pfem::Analysis::plane_stress)
    for (const auto& each : materials) scene.in_bending.push_back(each.in_bending.value_or(each.elasticity));
  const auto& expansion = materials.front().expansion;
  if (std::ranges::all_of(materials, [&](const auto& each) { return each.expansion == expansion; }))
    scene.expansion = expansion;
  scene.geometry = read_geometry(root.at("geometry"), materials);
  check_laminates(root, materials, scene);
  std::set<std::string> disc_ids;
  scene.holes = read_holes(root, std::holds_alternative<GridGeometry>(scene.geometry), disc_ids);
  scene.points = read_points(root, disc_ids);
  scene.cracks = read_cracks(root, scene);
  const auto discs = root.find("disc_directions");
  scene.disc_directions = discs ? read_directions(*discs) : std::vector(rim::both_axes.begin(), rim::both_axes.end());
  read_sections(root, scene);
  if (const auto* grid = std::get_if<GridGeometry>(&scene.geometry)) set_default_rings(*grid, scene);
  scene.supports = read_supports(root, edge_names(scene));
  scene.externals = read_externals(root, edge_names(scene), scene.holes);
  if (const auto space = root.find("space")) scene.space = pfem::space_named(space->choice(pfem::space_names));
  read_p(root, scene);
  return scene;
}

void set_degrees(PlateScene& scene, const std::string& option) {
  if (option.empty()) return;
  const auto dots = option.find("..");
  const int low = degree(std::string_view(option).substr(0, dots));
  const int high = dots == std::string::npos ? low : degree(std::string_view(option).substr(dots + 2));
  if (low < 1 || high < low || high > pfem::highest_p)
    throw InputError(fmt::format("--p: '{}' is not allowed; allowed: a degree from 1 to {}, or a range such as 1..{}",
                                 option, pfem::highest_p, pfem::highest_p));
  scene.p_low = low;
  scene.p_high = high;
}

Eigen::VectorXi degrees(const PlateScene& scene) {
  return Eigen::VectorXi::LinSpaced(scene.p_high - scene.p_low + 1, scene.p_low, scene.p_high);
}

void reject(const PlateScene& scene, const std::string& pointer, const std::string& found, const std::string& allowed) {
  throw InputError(fmt::format("{}: {}: {}; allowed: {}", scene.file, pointer, found, allowed));
}

}  // namespace fastjoint::stage1
