// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"

namespace fastjoint::formats {
namespace {

/// Labels of the units; empty if a hand-made file has none or malformed ones.
Units labels(const std::string& text) {
  const auto units = nlohmann::json::parse(text, nullptr, false);
  const auto label = [&](const char* key) -> std::string {
    return units.is_object() && units.contains(key) && units[key].is_string() ? units[key] : "";
  };
  return {label("length"), label("force")};
}

/// True if a symmetric matrix with units has no eigenvalue below zero by more than rounding, and all its diagonal is
/// positive.
bool is_compliance(const Eigen::Matrix3d& A) {
  constexpr double rounding = 1e-8;
  if (!(A.diagonal().minCoeff() > 0)) return false;
  const Eigen::Vector3d scale = A.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::Matrix3d unit_diagonal = scale.asDiagonal() * A * scale.asDiagonal();
  unit_diagonal.diagonal().array() += rounding;
  return matrices::is_positive_definite(unit_diagonal);
}

const h5::Allowed angles{
    .text = "angles up to a full turn", .low = std::numeric_limits<double>::min(), .high = (1 + 1e-9) * rim::full_turn};

/// Bearing sides of tractions; "" for an edge and where a file has none.
h5::Allowed traction_sides() {
  auto names = side_names;
  names.emplace_back();
  return {.text = fmt::format("one of {}, or none", fmt::join(side_names, ", ")), .words = names, .word = ""};
}

/// The root attribute `space`; a file without it leaves `a` unchanged.
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

/// The datasets of UnitCases::waves. @param n_contact Number of rims of contact, which come first.
template <class File, class Waves>
void wave_datasets(File& file, Waves& a, Eigen::Index n_contact, const Units& units) {
  using h5::Column;
  const auto column = [&](const char* name, auto member, const std::string& unit, const char* meaning,
                          const h5::Allowed& allowed) {
    file(name, Column{a, member}, {std::ssize(a)}, unit, meaning, allowed);
  };
  file("wave/hole", Column{a, &WaveRim::hole}, {h5::any}, "1",
       "holes around which the elements carry waves: those of contact, whose waves are also loads, then others",
       h5::or_else(""));
  if constexpr (File::reads)
    if (std::ssize(a) < n_contact)
      throw FileError(fmt::format("{}:wave/hole: has {} holes, expected at least the {} of pressure/hole", file.path(),
                                  a.size(), n_contact));
  column(
      "wave/order", [](auto& rim) -> auto& { return rim.waves.highest; }, "1",
      "number of waves around a whole circle of the shortest wave that the elements carry",
      h5::integers(1, rim::max_harmonics));
  column("wave/start", [](auto& rim) -> auto& { return rim.waves.start; }, "rad",
         "where the rim that the model has begins, counter-clockwise from x", {});
  column(
      "wave/sweep", [](auto& rim) -> auto& { return rim.waves.sweep; }, "rad", "angle that this rim covers", angles);
  column("wave/radius", &WaveRim::radius, unit(units, 1, 0), "radius of the hole", h5::positive);
  column("wave/area", &WaveRim::area, unit(units, 2, 0), "area of this rim", h5::positive);
  column("wave/modulus", &WaveRim::modulus, unit(units, -3, 1), "modulus of the springs, 0 of an open hole",
         h5::not_negative);
  file("wave/compliance", Column{a, &WaveRim::compliance}, {std::ssize(a), 3, 3}, unit(units, 2, -1),
       "strain (x, y, engineering xy) of the sheet at the rim per stress (x, y, xy); 0 where no closed form holds");
  if constexpr (File::reads)
    for (const auto& rim : a)
      if (!rim.compliance.isZero(0) && !is_compliance(rim.compliance))
        throw FileError(fmt::format(
            "{}:wave/compliance: that of hole \"{}\" is not positive definite, expected a positive definite "
            "matrix, or 0 where no closed form holds",
            file.path(), rim.hole));
  if (File::reads && a.empty()) return;  // files from other sources may have none
  std::vector<int> owner;
  std::vector<rim::AngleRange> arcs;
  if constexpr (!File::reads)
    for (int i = 0; i < std::ssize(a); ++i)
      for (const auto& arc : a[i].acts) owner.push_back(i), arcs.push_back(arc);
  file("wave/sprung", owner, {h5::any}, "1", "index in wave/hole of the rim of each arc on which springs act",
       h5::index_into(std::ssize(a)));
  file("wave/arc", Column{arcs, [](auto& arc) { return std::tie(arc.from, arc.to); }}, {std::ssize(owner), 2}, "rad",
       "start and end of each arc on which springs act, counter-clockwise from x");
  if constexpr (File::reads)
    for (std::size_t i = 0; i < owner.size(); ++i) a[owner[i]].acts.push_back(arcs[i]);
}

/// Coefficients of thermal expansion; no dataset of a sheet without.
template <class File, class Expansion>
void expansion_dataset(File& file, Expansion& a) {
  if constexpr (File::reads) {
    if (!file.has("expansion")) return;
  }
  file("expansion", a, {h5::any}, "1/degree", "free strain x, y and xy, of the tensor, per degree of temperature");
  if constexpr (File::reads)
    if (a.size() != 0 && a.size() != 3)
      throw FileError(fmt::format("{}:expansion: holds {} numbers, expected 3, or none", file.path(), a.size()));
}

/// Places of the forces on a plate; no datasets before these had any.
template <class File, class Places>
void place_datasets(File& file, Places& a, const Units& units, const UnitCases& cases) {
  if constexpr (File::reads) {
    if (!file.has("support/range")) return;
  } else {
    if (!a.is_known()) return;
  }
  const std::string length = unit(units, 1, 0);
  file("disc/center", a.disc, {cases.n_discs(), 2}, length, "x and y of each disc");
  file("external/range", a.external, {cases.n_externals(), 2}, length,
       "least and greatest coordinate of each external along its direction");
  file("traction/range", a.traction, {cases.n_tractions(), 2}, length,
       "least and greatest coordinate of each traction along its direction, 0 of a moment");
  file("support/range", a.support, {2, 2}, length,
       "least and greatest x of the supports that fix x, then y of those that fix y, 0 of none");
  file("support/middle", a.support_middle, {2, 2}, length, "least and greatest of the middles of these edges");
}

}  // namespace

template <class File>
void header(File& file, Data<File, Header>& a) {
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
template void header<h5::Writer>(h5::Writer&, const Header&);
template void header<h5::Reader>(h5::Reader&, Header&);

template <class File>
void contact_datasets(File& file, Data<File, std::vector<ContactRim>>& a, const Units& units,
                      const std::string& group) {
  using h5::Column;
  const auto column = [&](const char* name, auto member, const std::string& unit, const char* meaning,
                          const h5::Allowed& allowed) {
    file(group + name, Column{a, member}, {std::ssize(a)}, unit, meaning, allowed);
  };
  file(group + "pressure/hole", Column{a, &ContactRim::hole}, {h5::any}, "1",
       "holes whose springs push but do not pull", h5::or_else(""));
  column(
      "pressure/harmonics", [](auto& rim) -> auto& { return rim.pressures.highest; }, "1",
      "number of waves around a whole circle of the shortest pressure of contact; 0: as many as a joint asks for",
      h5::integers(0, rim::max_harmonics));
  column("pressure/start", [](auto& rim) -> auto& { return rim.pressures.start; }, "rad",
         "where the rim that the model has begins, counter-clockwise from x", {});
  column(
      "pressure/sweep", [](auto& rim) -> auto& { return rim.pressures.sweep; }, "rad", "angle that this rim covers",
      angles);
  column("pressure/modulus", &ContactRim::modulus, unit(units, -3, 1), "modulus of the springs", h5::positive);
  column("pressure/radius", &ContactRim::radius, unit(units, 1, 0), "radius of the hole", h5::positive);
  column("pressure/area", &ContactRim::area, unit(units, 2, 0), "area of this rim", h5::positive);
  column(
      "pressure/disk_E", [](auto& rim) -> auto& { return rim.disk.E; }, unit(units, -2, 1),
      "Young's modulus, of plane stress, of the elastic disk that presses on this rim in place of the springs; 0: "
      "springs",
      h5::not_negative.or_else(0));
  column(
      "pressure/disk_nu", [](auto& rim) -> auto& { return rim.disk.nu; }, "1",
      "Poisson's ratio, of plane stress, of this disk",
      h5::Allowed{.text = "numbers from -1 to 1", .low = -1, .high = 1}.or_else(0));
}
template void contact_datasets<h5::Writer>(h5::Writer&, const std::vector<ContactRim>&, const Units&,
                                           const std::string&);
template void contact_datasets<h5::Reader>(h5::Reader&, std::vector<ContactRim>&, const Units&, const std::string&);

template <class File>
void border_datasets(File& file, Data<File, Border>& a, const Units& units, const std::string& group) {
  file(group + "border/free", h5::Column{a, &pfem::OutlinePiece::is_free}, {h5::any}, "1",
       "pieces of the sheet's outline: 1 for an edge without supports and externals, else 0",
       h5::integers(0, 1).or_else(0));
  const auto ends = [](auto& piece) { return std::tie(piece.from.x(), piece.from.y(), piece.to.x(), piece.to.y()); };
  file(group + "border/ends", h5::Column{a, ends}, {std::ssize(a), 4}, unit(units, 1, 0),
       "x and y of both ends of each piece, arcs as chords", h5::or_else(0));
}
template void border_datasets<h5::Writer>(h5::Writer&, const Border&, const Units&, const std::string&);
template void border_datasets<h5::Reader>(h5::Reader&, Border&, const Units&, const std::string&);

template <class File>
void bay_datasets(File& file, Data<File, std::vector<Bay>>& a, const Units& units, const std::string& group) {
  using h5::Column;
  file(group + "bay/direction", Column{a, &Bay::direction}, {h5::any}, "1",
       "axis, x or y, of each bay of the sheet as a beam", h5::or_else(""));
  const Eigen::Index n = std::ssize(a);
  const std::string length = unit(units, 1, 0);
  const auto ends = [](auto& bay) { return std::tie(bay.from, bay.to); };
  file(group + "bay/ends", Column{a, ends}, {n, 2}, length, "coordinates between which it lies", h5::or_else(0));
  file(group + "bay/width", Column{a, &Bay::width}, {n}, length, "mean width, holes filled", h5::positive.or_else(1));
  file(group + "bay/thickness", Column{a, &Bay::thickness}, {n}, length, "mean thickness", h5::positive.or_else(1));
  file(group + "bay/membrane", Column{a, &Bay::membrane}, {n}, unit(units, 0, 1), "stiffness E A in tension",
       h5::positive.or_else(1));
  file(group + "bay/bending", Column{a, &Bay::bending}, {n}, unit(units, 2, 1), "stiffness E I in cylindrical bending",
       h5::positive.or_else(1));
  const auto held = [](auto& bay) { return std::tie(bay.held_from, bay.held_to); };
  file(group + "bay/held", Column{a, held}, {n, 2}, "1",
       "1 where a support or an external is on that end of the sheet, else 0", h5::integers(0, 1).or_else(0));
}
template void bay_datasets<h5::Writer>(h5::Writer&, const std::vector<Bay>&, const Units&, const std::string&);
template void bay_datasets<h5::Reader>(h5::Reader&, std::vector<Bay>&, const Units&, const std::string&);

template <class File>
void tip_datasets(File& file, Data<File, std::vector<pfem::CrackTip>>& a, const Units& units, const std::string& group,
                  bool with_angle) {
  using h5::Column;
  file(group + "crack/tip", Column{a, &pfem::CrackTip::id}, {h5::any}, "1", "tip of each crack", h5::or_else(""));
  const Eigen::Index t = std::ssize(a);
  file(group + "crack/at", Column{a, &pfem::CrackTip::at}, {t, 2}, unit(units, 1, 0), "x and y of each tip");
  if (with_angle)
    file(group + "crack/angle", Column{a, &pfem::CrackTip::angle}, {t}, "rad",
         "direction in which the crack would grow at each tip, counter-clockwise from x");
  file(group + "crack/length", Column{a, &pfem::CrackTip::length}, {t}, unit(units, 1, 0),
       "length of the crack from its other end, half of it if both ends are tips", h5::positive);
}
template void tip_datasets<h5::Writer>(h5::Writer&, const std::vector<pfem::CrackTip>&, const Units&,
                                       const std::string&, bool);
template void tip_datasets<h5::Reader>(h5::Reader&, std::vector<pfem::CrackTip>&, const Units&, const std::string&,
                                       bool);

template <class File>
void unit_case_datasets(File& file, Data<File, UnitCases>& a, const std::vector<std::string>* holes) {
  using h5::any;
  const Units& units = a.header.units;
  const auto or_if_foreign = [&](const h5::Allowed& own, const auto& otherwise) {
    return holes ? own : h5::or_else(otherwise);
  };
  const h5::Allowed axis = holes ? h5::one_of({"x", "y"}) : h5::Allowed{};
  h5::Allowed hole{.text = "names in hole/id"}, hole_or_edge = h5::or_else("");
  if (holes) {
    hole.words = *holes;
    hole_or_edge = hole;
    hole_or_edge.words->emplace_back();
  }
  space(file, a.space);
  file("p", a.p, {h5::some}, "1", "polynomial degrees", degrees(holes ? pfem::highest_p : highest_degree));
  file("ndof", a.ndof, {a.p.size()}, "1", "free plate unknowns at each degree of p",
       or_if_foreign({.text = "numbers that do not fall", .low = 0, .step = 0}, 0));
  file("disc/hole", a.disc_hole, {any}, "1", "hole or point of each disc, once for each direction of motion");
  file("disc/direction", a.disc_direction, {a.n_discs()}, "1", "direction of each disc, x or y", axis);
  file("external/id", a.external_id, {any}, "1", "external boundaries that move as one", or_if_foreign({}, ""));
  file("external/direction", a.external_direction, {a.n_externals()}, "1", "x or y, for each external",
       or_if_foreign(axis, "x"));
  file("traction/id", a.traction_id, {any}, "1", traction_boundaries, or_if_foreign({}, ""));
  const Eigen::Index q = a.n_tractions();
  file("traction/direction", a.traction_direction, {q}, "1", "x, y or rotation, for each traction",
       or_if_foreign(h5::one_of({"x", "y", rotation}), "x"));
  if (File::reads || std::ssize(a.traction_arm) == q)
    file("traction/arm", a.traction_arm, {q}, unit(units, 1, 0), traction_arm, h5::or_else(0));
  file("held/at", a.held_at, {any}, unit(units, 1, 0),
       "x and y where a sheet that nothing holds is held against rigid motions", h5::or_else(0));
  file("held/moment", a.traction_moment, {a.held_at.size() > 0 ? q : 0}, unit(units, 1, 0),
       "moment about there of each unit traction on such a sheet", h5::or_else(0));
  file("traction/bearing", a.traction_bearing, {q}, "1", bearing_side, traction_sides());
  file("traction/hole", a.traction_hole, {q}, "1", "open hole that each traction presses on, empty for an edge",
       hole_or_edge);
  contact_datasets(file, a.contact, units);
  wave_datasets(file, a.waves, std::ssize(a.contact), units);
  border_datasets(file, a.border, units);
  bay_datasets(file, a.bays, units);
  file("friction/hole", a.friction_hole, {any}, "1", "hole of each friction case", or_if_foreign(hole, ""));
  file("friction/bearing", a.friction_bearing, {a.n_friction_cases()}, "1",
       "bearing side of each friction case: +x, -x, +y, -y", h5::one_of(side_names));
  place_datasets(file, a.places, units, a);
  expansion_dataset(file, a.expansion);
}
template void unit_case_datasets<h5::Writer>(h5::Writer&, const UnitCases&, const std::vector<std::string>*);
template void unit_case_datasets<h5::Reader>(h5::Reader&, UnitCases&, const std::vector<std::string>*);

h5::Allowed degrees(int highest) {
  return {.text = fmt::format("ascending degrees from 1 to {}", highest), .low = 1, .high = double(highest), .step = 1};
}

}  // namespace fastjoint::formats
