// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/joint_result.hpp"

#include <array>

namespace fastjoint::formats {
namespace {

using h5::any;
using h5::Column;

const h5::Format result_format{"joint-result", 1, 16};

using V = RimValues;
using enum Dimension;
constexpr auto quantities = std::to_array<RimQuantity>({
    {"bearing_load", &V::bearing_load, force, "bearing force of the fastener on the plate along x"},
    {"bearing_load_y", &V::bearing_load_y, force, "bearing force of the fastener on the plate along y"},
    {"bearing_stress", &V::bearing_stress, stress, "magnitude of the bearing force over the projected area d t"},
    {"bypass_load", &V::bypass_load, force,
     "force that passes the fastener by, in the direction of the larger principal stress, tension positive", true,
     false, true},
    {"bypass_error", &V::bypass_error, force, "estimated error of the bypass load", true, true},
    {"peak_hoop", &V::peak_hoop, stress, "largest hoop stress at the rim", false, false, false, true},
    {"peak_angle", &V::peak_angle, angle, "angle of the largest hoop stress, counter-clockwise from x", false, false,
     false, true},
    {"peak_error", &V::peak_error, stress, "estimated error of the largest hoop stress", false, true},
    {"gross_concentration", &V::gross_concentration, ratio, "peak over the stress of the gross section", true},
    {"net_concentration", &V::net_concentration, ratio, "peak over the stress of the net section", true},
    {"net_stress", &V::net_stress, stress, "largest tension over the net sections next to the hole, in any direction",
     true, false, true},
    {"against_slip", &V::against_slip, angle,
     "part of the contact on which friction acts against the slip that it assumes"},
    {"bypass_stress", &V::bypass_stress, stress, "bypass load over the gross section, tension positive", true, false,
     true},
    {"bypass_direction", &V::bypass_direction, angle, "direction of the bypass load, counter-clockwise from x", true},
    {"net_direction", &V::net_direction, angle, "direction of the net stress, counter-clockwise from x", true},
    {"bypass_across", &V::bypass_across, stress, "principal stress across the direction of the bypass load", true,
     false, true},
});

/// Datasets of the stresses at a distance from the rims.
template <class File, class Rims, class Near>
void near_datasets(File& file, const std::string& group, Rims& a, Near& near, Eigen::Index steps, const Units& units) {
  const std::string stress = unit_of(Dimension::stress, units);
  const Eigen::Index r = a.hole.size();
  file(group + "near/distance", near.distance, {}, unit(units, 1, 0), "distance of the circles from the rims");
  file(group + "near/peak_hoop", near.peak, {steps, r}, stress, "largest hoop stress on the circle", h5::nan_too);
  file(group + "near/peak_angle", near.angle, {steps, r}, "deg", "angle of it, counter-clockwise from x", h5::nan_too);
  file(group + "near/peak_error", near.error, {steps, r}, stress, "estimated error of it", h5::infinite_too);
  if (!a.stresses) return;
  const Eigen::Index k = a.stresses->angle.size();
  const char* meaning = "stress at this distance outwards from each point";
  file(group + "near/sigma_rr", near.rr, {steps, k}, stress, std::string("radial ") + meaning, h5::infinite_too);
  file(group + "near/sigma_tt", near.tt, {steps, k}, stress, std::string("hoop ") + meaning, h5::infinite_too);
  file(group + "near/sigma_rt", near.rt, {steps, k}, stress, std::string("shear ") + meaning, h5::infinite_too);
}

template <class File, class Rims>
void rim_datasets(File& file, const std::string& group, Rims& a, Eigen::Index steps, const Units& units) {
  file(group + "hole", a.hole, {any}, "1", "holes, open ones included");
  const Eigen::Index r = a.hole.size();
  file(group + "sections", a.sections, {r}, "1", "number of sections next to each hole");
  file(group + "center", a.center, {r, 2}, unit(units, 1, 0), "x and y of each hole's centre", h5::or_else(0));
  file(group + "radius", a.radius, {r}, unit(units, 1, 0), "radius of each hole", h5::or_else(0));
  const auto sizes = [&](const char* name, auto& value, int power, const char* meaning) {
    if (File::reads || value.size() == r)
      file(group + name, value, {r}, unit(units, power, 0), meaning, h5::or_else(0));
  };
  sizes("thickness", a.thickness, 1, "mean thickness of the plate at each hole, 0 if not known");
  sizes("gross_area", a.gross_area, 2,
        "area of the smaller section across x next to the hole, without it, 0 if there is none");
  sizes("net_area", a.net_area, 2, "net area of this section");
  sizes("gross_area_y", a.gross_area_y, 2, "the same as gross_area, across y");
  sizes("net_area_y", a.net_area_y, 2, "the same as net_area, across y");
  for (const auto& each : quantities) {
    const auto row = [&](auto& holes) { return Column{holes, each.value}; };
    file(group + each.name, Column{a.values, row}, {steps, r}, unit_of(each.dimension, units), each.meaning,
         each.may_be_nan                        ? h5::nan_too
         : each.may_be_unknown || each.is_error ? h5::infinite_too
                                                : h5::Allowed{});
  }
  if (auto* around = file.part(group + "sigma_tt", a.stresses)) {
    file(group + "start", around->start, {r + 1}, "1", "first point of each rim, and the number of points",
         h5::integers(0, std::numeric_limits<int>::max()));
    const Eigen::Index n = r > 0 ? around->start[r] : 0;
    file(group + "angle", around->angle, {n}, "deg", "place of each point on its rim, counter-clockwise from x");
    const std::string stress = unit_of(Dimension::stress, units);
    file(group + "sigma_rr", around->rr, {steps, n}, stress, "radial stress of the sheet at each point");
    file(group + "sigma_tt", around->tt, {steps, n}, stress, "hoop stress at each point");
    file(group + "sigma_rt", around->rt, {steps, n}, stress, "shear stress at each point");
  }
  if (auto* near = file.part(group + "near/peak_hoop", a.near)) near_datasets(file, group, a, *near, steps, units);
}

template <class File, class Cracks>
void crack_datasets(File& file, const std::string& group, Cracks& a, Eigen::Index steps, const Units& units) {
  file(group + "tip", a.tip, {any}, "1", "tip of each crack", h5::or_else(""));
  const Eigen::Index t = a.tip.size();
  if (File::reads && t == 0) return;
  const std::string intensity = unit(units, -1.5, 1);
  file(group + "at", a.at, {t, 2}, unit(units, 1, 0), "x and y of each tip");
  file(group + "length", a.length, {t}, unit(units, 1, 0),
       "length of the crack from its other end, half of it if both ends are tips");
  file(group + "K_I", a.K_I, {steps, t}, intensity, "stress intensity factor of the opening mode at each tip");
  file(group + "K_II", a.K_II, {steps, t}, intensity, "stress intensity factor of the sliding mode at each tip");
  file(group + "K_I_error", a.K_I_error, {steps, t}, intensity, "estimated error of K_I", h5::infinite_too);
  file(group + "K_II_error", a.K_II_error, {steps, t}, intensity, "estimated error of K_II", h5::infinite_too);
}

template <class File, class Plate>
void total_datasets(File& file, const std::string& group, Plate& a, Eigen::Index steps, const Units& units) {
  if constexpr (File::reads) {
    if (!file.has(group + "total/applied")) return;  // before version 1.13
  } else {
    if (a.applied.cols() == 0) return;
  }
  const std::string force = unit(units, 0, 1), length = unit(units, 1, 0);
  const Eigen::Index q = std::ssize(a.traction_id);
  file(group + "traction/arm", a.traction_arm, {q}, length, traction_arm);
  file(group + "traction/displacement", a.traction_displacement, {steps, q}, length,
       "mean displacement of each traction boundary along its direction, of a moment rotation times arm",
       h5::infinite_too);
  file(group + "free/D", a.free_D, {steps, std::ssize(a.disc_hole)}, length,
       "part of D that deforms nothing: free expansion, and holes off their place");
  file(group + "free/De", a.free_De, {steps, std::ssize(a.external_id)}, length, "part of De by free expansion");
  file(group + "total/applied", a.applied, {steps, 2}, force, "force of externals along x and y");
  file(group + "total/by_fasteners", a.by_fasteners, {steps, 2}, force, "force of the fasteners along x and y");
  file(group + "total/by_supports", a.by_supports, {steps, 2}, force,
       "minus the sum of these: the reaction of supports, or where there are none what is out of balance");
  auto& rows = a.rows;
  file(group + "row/direction", rows.direction, {any}, "1", "x or y, for each row of holes with that coordinate");
  const Eigen::Index w = std::ssize(rows.direction);
  file(group + "row/at", rows.at, {w}, length, "this coordinate");
  file(group + "row/holes", rows.holes, {w}, "1", "number of holes in the row");
  file(group + "row/force", rows.force, {steps, w}, force, "force of the fasteners of each row along its direction");
  const char* section = "force in the plate over its whole section there, tension positive";
  file(group + "row/before", rows.before, {steps, w}, force, section, h5::infinite_too);
  file(group + "row/after", rows.after, {steps, w}, force, section, h5::infinite_too);
}

template <class File, class Plate>
void plate_datasets(File& file, Plate& a, Eigen::Index steps, const Units& units) {
  const std::string group = "plates/" + a.name + "/", length = unit(units, 1, 0), force = unit(units, 0, 1);
  file(group + "disc/hole", a.disc_hole, {any}, "1", "hole or point of each disc, once for each direction of motion");
  const Eigen::Index m = a.disc_hole.size();
  file(group + "disc/direction", a.disc_direction, {m}, "1", "direction of each disc, x or y");
  if (auto* forces = file.part(group + "disc/bearing", a.disc_forces)) {
    file(group + "disc/bearing", forces->bearing, {steps, m}, force, "bearing force of the fastener on each disc");
    file(group + "disc/friction", forces->friction, {steps, m}, force, "resultant of its friction along each disc");
  }
  file(group + "external/id", a.external_id, {any}, "1", "external boundaries that move as one");
  const Eigen::Index e = a.external_id.size();
  file(group + "D", a.D, {steps, m}, length, "displacement of each disc");
  file(group + "De", a.De, {steps, e}, length, "displacement of each external");
  file(group + "Pe", a.Pe, {steps, e}, force, "force on each external");
  contact_datasets(file, a.contact, units, group);
  const Eigen::Index g = a.contact.size();
  if constexpr (File::reads) a.waves.resize(g);
  const auto order_of = [](auto& rim) -> decltype(auto) { return (rim.waves.highest); };
  file(group + "wave/order", Column{a.waves, order_of}, {g}, "1", "highest order of the waves of each rim of contact",
       h5::integers(1, rim::max_harmonics));
  Eigen::Index k = 0, n_w = 0;
  for (Eigen::Index i = 0; i < g; ++i) {
    if constexpr (File::reads) {
      const int order = a.waves[i].waves.highest;
      a.waves[i].hole = a.contact[i].hole;
      a.waves[i].waves = a.contact[i].pressures;
      a.waves[i].waves.highest = order;
    }
    k += a.waves[i].size();
    n_w += a.contact[i].pressures.size();
  }
  file(group + "wave/amount", a.amounts, {steps, k}, unit(units, -2, 1),
       "amplitude of each of these waves, pressures then shears, rim after rim; for pressures the difference from "
       "linear springs all around");
  file(group + "contact/w", a.w, {steps, n_w}, length,
       "mean over the rim of the disc's normal displacement relative to the sheet times each distribution of pressure, "
       "rim "
       "after rim");
  file(group + "contact/gap", a.contacts.gap, {g}, length, "radial gap of each rim, negative for interference");
  file(group + "contact/no_load_peak", a.contacts.no_load_peak, {g}, unit(units, -2, 1),
       "largest pressure on the rim at no load", h5::or_else(0));
  file(group + "contact/no_load_least", a.contacts.no_load_least, {g}, unit(units, -2, 1),
       "smallest pressure on the rim at no load", h5::or_else(0));
  file(group + "contact/full_until", a.contacts.full_until, {g}, "1",
       "load factor at which a rim with interference first loses full contact", h5::not_negative.or_else(h5::infinite));
  file(group + "contact/touching", a.contacts.touching, {steps, g}, "deg", "angle over which disc and rim touch");
  file(group + "contact/from", a.contacts.from, {steps, g}, "deg", "start of the widest arc on which they touch");
  file(group + "contact/to", a.contacts.to, {steps, g}, "deg", "end of this arc, counter-clockwise from x");
  file(group + "contact/peak_pressure", a.contacts.peak_pressure, {steps, g}, unit(units, -2, 1),
       "largest pressure on the rim");
  file(group + "contact/peak_angle", a.contacts.peak_angle, {steps, g}, "deg",
       "place of this pressure, or of the smallest gap");
  file(group + "contact/least_gap", a.contacts.least_gap, {steps, g}, length,
       "smallest gap between disc and rim, 0 where they touch");
  file(group + "friction/hole", a.friction_hole, {any}, "1", "hole of each friction case");
  const Eigen::Index h = a.friction_hole.size();
  file(group + "friction/bearing", a.friction_bearing, {h}, "1", "bearing side of each friction case: +x, -x, +y, -y");
  file(group + "Lambda", a.Lambda, {steps, h}, unit(units, -2, 1), "peak stress of each friction case");
  file(group + "traction/id", a.traction_id, {any}, "1", traction_boundaries);
  file(group + "traction/bearing", a.traction_bearing, {std::ssize(a.traction_id)}, "1", bearing_side,
       traction_sides());
  file(group + "traction/force", a.traction, {steps, std::ssize(a.traction_id)}, force, "total force of each traction");
  total_datasets(file, group, a, steps, units);
  rim_datasets(file, group + "rim/", a.rims, steps, units);
  border_datasets(file, a.border, units, group);
  crack_datasets(file, group + "crack/", a.cracks, steps, units);
}

template <class File, class Sensitivity>
void sensitivity_datasets(File& file, Sensitivity& a, Eigen::Index steps, Eigen::Index n, const Units& units) {
  const std::string group = "sensitivity/", force = unit(units, 0, 1), stiffness = unit(units, -1, 1);
  const auto names = [&](const char* name, auto& value, Eigen::Index count, const char* meaning) {
    file(group + name, value, {count}, "1", meaning);
  };
  const auto tables = [&](const char* name, auto& value, Eigen::Index columns, const std::string& unit,
                          const char* meaning) {
    file(group + name, value, {steps, n, columns}, unit, meaning, h5::infinite_too);
  };
  file(group + "load_factor", a.load_factor, {steps, n}, force, "dF by the load factor", h5::infinite_too);
  tables("clearance", a.clearance, n, stiffness, "dF by the clearance of each shear plane");
  names("mu_hole", a.mu_hole, any, "plate:hole, each with friction");
  tables("mu", a.mu, std::ssize(a.mu_hole), force, "dF by the coefficient of friction of each hole");
  names("law_name", a.law_name, any, "name of the law that each number belongs to");
  const Eigen::Index l = a.law_name.size();
  names("law_number", a.law_number, l, "name of each number in its law");
  names("law_unit", a.law_unit, l, "unit of the derivative by each number");
  tables("law", a.law, l, "law_unit", "dF by each number of the laws");
  names("force_external", a.force_external, any, "plate:external that may carry a force");
  tables("force", a.force, std::ssize(a.force_external), "1", "dF by the force on each at load factor 1");
  names("displacement_external", a.displacement_external, any, "plate:external with a given displacement");
  tables("displacement", a.displacement, std::ssize(a.displacement_external), stiffness,
         "dF by the displacement of each at load factor 1");
  if constexpr (File::reads)
    if (!file.has(group + "gap_hole")) return;  // before version 1.6
  names("gap_hole", a.gap_hole, any, "plate:hole, each with springs that push but do not pull");
  tables("gap", a.gap, std::ssize(a.gap_hole), stiffness, "dF by the radial gap of each");
  if constexpr (File::reads)
    if (!file.has(group + "peak/hole")) return;  // before version 1.10
  names("peak/hole", a.peak.hole, any, "plate:hole whose peak hoop stress is differentiated at the last increment");
  const Eigen::Index r = std::ssize(a.peak.hole);
  const std::string stress = unit(units, -2, 1), gradient = unit(units, -3, 1);
  file(group + "peak/load_factor", a.peak.load_factor, {r}, stress, "dpeak by the load factor", h5::infinite_too);
  const auto slopes = [&](const char* name, auto& value, Eigen::Index columns, const std::string& unit,
                          const char* meaning) {
    file(group + name, value, {r, columns}, unit, meaning, h5::infinite_too);
  };
  slopes("peak/clearance", a.peak.clearance, n, gradient, "dpeak by the clearance of each shear plane");
  slopes("peak/law", a.peak.law, l, "law_unit/" + unit(units, 1, 0) + "^2", "dpeak by each number of the laws");
  slopes("peak/mu", a.peak.mu, std::ssize(a.mu_hole), stress, "dpeak by the coefficient of friction of each hole");
  slopes("peak/force", a.peak.force, std::ssize(a.force_external), unit(units, -2, 0),
         "dpeak by the force on each at load factor 1");
  slopes("peak/displacement", a.peak.displacement, std::ssize(a.displacement_external), gradient,
         "dpeak by the displacement of each at load factor 1");
  slopes("peak/gap", a.peak.gap, std::ssize(a.gap_hole), gradient, "dpeak by the radial gap of each");
}

template <class File, class Tables>
void envelope_datasets(File& file, Tables& all, Eigen::Index steps) {
  file("envelope/quantity", Column{all, &EnvelopeTable::quantity}, {any}, "1",
       "quantities of the envelope, each with a group; none if the joint has no cases", h5::or_else(""));
  if constexpr (File::reads) return;  // it follows from the rest, and its units from its quantities
  for (auto& a : all) {
    const std::string group = "envelope/" + a.quantity + "/";
    file(group + "of", a.of, {any}, "1", "shear plane, plate:hole, plate:external or plate:tip");
    const Eigen::Index k = std::ssize(a.of);
    file(group + "largest", a.largest, {k}, a.unit, "largest value over all increments of all cases", h5::infinite_too);
    file(group + "largest_at", a.largest_at, {k}, "1", "row where it stands", h5::integers(0, int(steps) - 1));
    file(group + "smallest", a.smallest, {k}, a.unit, "smallest value", h5::infinite_too);
    file(group + "smallest_at", a.smallest_at, {k}, "1", "row where it stands", h5::integers(0, int(steps) - 1));
  }
}

template <class File, class Table>
void margin_datasets(File& file, Table& a, Eigen::Index steps) {
  file("margin/check", a.check, {any}, "1", "check of each margin, the smallest margin first", h5::or_else(""));
  const Eigen::Index m = std::ssize(a.check);
  file("margin/of", a.of, {m}, "1", "shear plane, or plate:hole", h5::or_else(""));
  file("margin/margin", a.margin, {m}, "1", "allowable / (FS FF applied) - 1; infinite where nothing is applied",
       h5::infinite_too);
  file("margin/allowable", a.allowable, {m}, "1", "allowable load or stress", h5::infinite_too);
  file("margin/applied", a.applied, {m}, "1", "applied load or stress", h5::infinite_too);
  file("margin/edge_ratio", a.edge_ratio, {m}, "1",
       "distance of the hole's centre from the edge along its load over its diameter; infinite if it plays no part",
       h5::infinite_too);
  file("margin/direction", a.direction, {m}, "deg",
       "direction of the applied load or stress, counter-clockwise from x; infinite if it plays no part",
       h5::infinite_too.or_else(h5::infinite));
  file("margin/at", a.at, {m}, "1", "row of the increment that governs", h5::integers(0, int(steps) - 1));
  file("margin/unit", a.unit, {m}, "1", "unit of the allowable and of what is applied", h5::or_else(""));
  file("margin/formula", a.formula, {m}, "1", "formula of the allowable", h5::or_else(""));
  file("margin/inputs", a.inputs, {m}, "1", "its numbers and the factors", h5::or_else(""));
}

/// What laws remember; nothing if none does.
template <class File, class Result>
void memory_datasets(File& file, Result& a, Eigen::Index steps, Eigen::Index rows, const Units& units) {
  if constexpr (File::reads) {
    if (!file.has("memory/set")) return;
  } else {
    if (a.set.size() == 0) return;
  }
  const Eigen::Index n = a.fastener_id.size(), directions = n > 0 ? rows / n : 0;
  file("memory/set", a.set, {steps, n, directions}, unit(units, 1, 0),
       "permanent set of each plane: the part of delta that yield or slip in bearing has left");
  file("memory/dissipated", a.dissipated, {steps, n}, unit(units, 1, 1),
       "energy that slip and yield of each plane have taken since the joint was unloaded");
}

template <class File, class Result>
void result_datasets(File& file, Result& a) {
  header(file, a.header);
  const Units& units = a.header.units;
  const std::string length = unit(units, 1, 0), force = unit(units, 0, 1);
  file.attribute("complete", a.complete);
  file.attribute("p", a.p);
  file("load_factor", a.load_factor, {any}, "1", "fraction of the loads at this increment");
  const Eigen::Index steps = a.load_factor.size();
  file("case/name", a.case_name, {any}, "1", "load cases; one without a name if the joint has none", h5::or_else(""));
  file("case/of", a.case_of, {steps}, "1", "load case of each increment, counted from 0", h5::or_else(0));
  file("governing/increment", a.governing, {}, "1",
       "increment that governs, among all from 1, 0 without any: what pictures and fields show unless told otherwise",
       h5::integers(0, int(steps)).or_else(0));
  file("governing/reason", a.governing_reason, {}, "1", "why it governs", h5::or_else(""));
  file("warning/code", a.warning_code, {any}, "1", "warnings, as stage3_nonlinear printed them", h5::or_else(""));
  file("warning/text", a.warning, {std::ssize(a.warning_code)}, "1", "text of each", h5::or_else(""));
  file("converged", a.converged, {steps}, "1", "1 where the increment converged");
  file("iterations", a.iterations, {steps}, "1", "iterations of the nonlinear solver, failed tries included");
  file("residual", a.residual, {steps}, "1",
       "largest residual, relative to the largest force that rigid fasteners carry");
  file("event", a.event, {steps}, "1",
       "fasteners that close, open, slip or yield at exactly this load factor, and events of rims in contact up to it");
  file("fastener/id", a.fastener_id, {any}, "1", "fastener of each shear plane, in the order of the input");
  const Eigen::Index n = a.fastener_id.size();
  file("fastener/first", a.first_hole, {n}, "1", "plate:hole on its first side");
  file("fastener/second", a.second_hole, {n}, "1", "plate:hole on its second side, or ground");
  file("direction", a.direction, {any}, "1", "directions of the discs");
  const Eigen::Index directions = a.direction.size();
  file("delta", a.delta, {steps, n}, length, "displacement of the first plate's disc relative to the second's");
  file("F", a.F, {steps, n}, force, "force of the fastener's law: of bearing, or transferred if it includes friction");
  if (auto* F_error = file.part("F_error", a.F_error))
    file("F_error", *F_error, {steps, n}, force, "estimated error of F by those of the plates' matrices",
         h5::infinite_too);
  file("delta_vector", a.delta_vector, {steps, n, directions}, length, "components of delta");
  file("F_vector", a.F_vector, {steps, n, directions}, force, "components of F");
  file("transferred", a.transferred, {steps, n, 2}, force,
       "bearing and friction together, on the first and on the second plate");
  memory_datasets(file, a, steps, n * directions, units);
  file("stiffness/external", a.load_external, {any}, "1", "plate:external of each load other than zero",
       h5::or_else(""));
  file("stiffness/tangent", a.load_stiffness, {steps, std::ssize(a.load_external)}, unit(units, -1, 1),
       "rise of force over that of displacement at each, as all loads grow together", h5::infinite_too.or_else(0));
  file("plate/name", Column{a.plates, &PlateHistory::name}, {any}, "1",
       "plates of the joint; group plates/<name> has the results of each");
  const Eigen::Index plates = a.plates.size();
  file("plate/materials", Column{a.plates, &PlateHistory::materials}, {plates}, "1",
       "JSON text of \"materials\" in each PLATE.json, empty if unknown", h5::or_else(""));
  file("plate/matrices_digest", Column{a.plates, &PlateHistory::matrices_digest}, {plates}, "1",
       "digest of the MATRICES.h5 of each plate, empty if it has none", h5::or_else(""));
  file("plate/plate_digest", Column{a.plates, &PlateHistory::plate_digest}, {plates}, "1",
       "digest of the PLATE.h5 that the matrices of each plate were extracted from", h5::or_else(""));
  for (auto& plate : a.plates) plate_datasets(file, plate, steps, units);
  envelope_datasets(file, a.envelope, steps);
  if (!a.margins.check.empty() || File::reads) margin_datasets(file, a.margins, steps);
  if (auto* sensitivity = file.part("sensitivity", a.sensitivity))
    sensitivity_datasets(file, *sensitivity, steps, n, units);
}

}  // namespace

std::span<const RimQuantity> rim_quantities() { return quantities; }

std::string unit_of(Dimension dimension, const Units& units) {
  return dimension == angle ? "deg" : dimension == ratio ? "1" : unit(units, dimension == stress ? -2 : 0, 1);
}

void write(const std::string& path, const JointResult& a) {
  h5::Writer file(path, result_format);
  result_datasets(file, a);
  file.commit();
}

JointResult read_joint_result(const std::string& path) {
  h5::Reader file(path, result_format);
  JointResult a;
  result_datasets(file, a);
  return a;
}

}  // namespace fastjoint::formats
