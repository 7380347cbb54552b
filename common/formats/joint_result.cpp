// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/joint_result.hpp"

#include <array>
#include <stdexcept>

namespace fastjoint::formats {

using columns::Of;

const columns::Quantity D{"D", columns::length, "displacement of each disc"};
const columns::Quantity De{"De",
                           columns::length,
                           "displacement of each external",
                           "displacement",
                           {},
                           columns::Output{"displacement", "displacements", "displacement of each rigid external"}};
const columns::Quantity free_D{"free/D", columns::length,
                               "part of D that deforms nothing: free expansion, and holes off their place"};
const columns::Quantity free_De{"free/De", columns::length, "part of De by free expansion"};
const columns::Quantity wave_amount{
    "wave/amount", columns::stress,
    "amplitude of each of these waves, pressures then shears, rim after rim; for pressures the difference "
    "from linear springs all around"};
const columns::Quantity Lambda{"Lambda", columns::stress, "peak stress of each friction case"};
const columns::Quantity traction_force{"traction/force", columns::force, "total force of each traction"};

namespace {

using h5::any;
using h5::Column;

const h5::Format result_format{"joint-result", 1, 19};

/// Reads the columns of a field. Files before version 1.13 do not have the free parts.
void read_columns(h5::Reader& file, const std::string& group, PlateHistory& a, Eigen::Index steps, const Units& units) {
  const Eigen::Index e = a.n_externals(), m = a.n_discs(), q = a.n_tractions();
  for (const auto& [quantity, of, n] :
       {std::tuple(&De, Of::external, e), std::tuple(&free_De, Of::external, e), std::tuple(&D, Of::disc, m),
        std::tuple(&free_D, Of::disc, m), std::tuple(&wave_amount, Of::wave, a.n_waves()),
        std::tuple(&Lambda, Of::friction_case, a.n_friction_cases()), std::tuple(&traction_force, Of::traction, q)}) {
    columns::Column column{*quantity, of, n, {}, Eigen::MatrixXd::Zero(steps, n)};
    if ((quantity != &free_D && quantity != &free_De) || file.has(group + quantity->path))
      file(group + quantity->path, column.rows, {steps, n}, unit_of(quantity->dimension, units), quantity->meaning);
    a.columns.put(std::move(column));
  }
}

/// The unit cases of a plate.
template <class File, class Plate>
void case_datasets(File& file, const std::string& group, Plate& a, const Units& units) {
  file(group + "disc/hole", a.disc_hole, {any}, "1", "hole or point of each disc, once for each direction of motion");
  file(group + "disc/direction", a.disc_direction, {std::ssize(a.disc_hole)}, "1", "direction of each disc, x or y");
  file(group + "external/id", a.external_id, {any}, "1", "external boundaries that move as one");
  contact_datasets(file, a.contact, units, group);
  const Eigen::Index g = a.contact.size();
  if constexpr (File::reads) a.waves.resize(g);
  const auto order_of = [](auto& rim) -> decltype(auto) { return (rim.waves.highest); };
  file(group + "wave/order", Column{a.waves, order_of}, {g}, "1", "highest order of the waves of each rim of contact",
       h5::integers(1, rim::max_harmonics));
  if constexpr (File::reads)
    for (Eigen::Index i = 0; i < g; ++i) {
      const int order = a.waves[i].waves.highest;
      a.waves[i].hole = a.contact[i].hole;
      a.waves[i].waves = a.contact[i].pressures;
      a.waves[i].waves.highest = order;
    }
  file(group + "friction/hole", a.friction_hole, {any}, "1", "hole of each friction case");
  file(group + "friction/bearing", a.friction_bearing, {std::ssize(a.friction_hole)}, "1",
       "bearing side of each friction case: +x, -x, +y, -y");
  file(group + "traction/id", a.traction_id, {any}, "1", traction_boundaries);
}

void write_holes(h5::Writer& file, const std::string& group, const HoleList& a, const Units& units) {
  const std::string length = unit(units, 1, 0), area = unit(units, 2, 0);
  const Eigen::Index r = std::ssize(a.hole);
  file(group + "hole", a.hole, {r}, "1", "holes, open ones included");
  file(group + "sections", a.sections, {r}, "1", "number of sections next to each hole");
  file(group + "center", a.center, {r, 2}, length, "x and y of each hole's centre");
  file(group + "radius", a.radius, {r}, length, "radius of each hole");
  if (a.thickness.size() == r)  // not in matrices before format 1.4
    file(group + "thickness", a.thickness, {r}, length, "mean thickness of the plate at each hole, 0 if not known");
  file(group + "gross_area", a.gross_area, {r}, area,
       "area of the smaller section across x next to the hole, without it, 0 if there is none");
  file(group + "net_area", a.net_area, {r}, area, "net area of this section");
  file(group + "gross_area_y", a.gross_area_y, {r}, area, "the same as gross_area, across y");
  file(group + "net_area_y", a.net_area_y, {r}, area, "the same as net_area, across y");
  if (a.start.size() > 0) {
    file(group + "start", a.start, {r + 1}, "1", "first point of each rim, and the number of points");
    file(group + "angle", a.angle, {a.angle.size()}, "deg", "place of each point on its rim, counter-clockwise from x");
  }
  if (a.near_distance)
    file(group + "near/distance", *a.near_distance, {}, length, "distance of the circles from the rims");
}

void write_things(h5::Writer& file, const std::string& group, const PlateHistory& a, const Units& units) {
  const std::string length = unit(units, 1, 0), stress = unit(units, -2, 1);
  const Eigen::Index q = std::ssize(a.traction_id), g = std::ssize(a.contact);
  file(group + "traction/bearing", a.traction_bearing, {q}, "1", bearing_side);
  file(group + "traction/arm", a.traction_arm, {q}, length, traction_arm);
  file(group + "contact/gap", a.at_no_load.gap, {g}, length, "radial gap of each rim, negative for interference");
  file(group + "contact/no_load_peak", a.at_no_load.peak, {g}, stress, "largest pressure on the rim at no load");
  file(group + "contact/no_load_least", a.at_no_load.least, {g}, stress, "smallest pressure on the rim at no load");
  file(group + "contact/full_until", a.at_no_load.full_until, {g}, "1",
       "load factor at which a rim with interference first loses full contact", h5::not_negative);
  write_holes(file, group + "rim/", a.holes, units);
  border_datasets(file, a.border, units, group);
  bay_datasets(file, a.bays, units, group);
  tip_datasets(file, a.tips, units, group, false);
  const Eigen::Index w = std::ssize(a.rows.direction);
  file(group + "row/direction", a.rows.direction, {w}, "1", "x or y, for each row of holes with that coordinate");
  file(group + "row/at", a.rows.at, {w}, length, "this coordinate");
  file(group + "row/holes", a.rows.holes, {w}, "1", "number of holes in the row");
  columns::write(file, group, a.columns, units);
}

void write_sensitivity(h5::Writer& file, const SensitivityHistory& a, Eigen::Index n, const Units& units) {
  const std::string group = "sensitivity/";
  const auto names = [&](const char* name, const std::vector<std::string>& value, const char* meaning) {
    file(group + name, value, {std::ssize(value)}, "1", meaning);
  };
  names("mu_hole", a.mu_hole, "plate:hole, each with friction");
  names("law_name", a.law_name, "name of the law that each number belongs to");
  names("law_number", a.law_number, "name of each number in its law");
  names("law_unit", a.law_unit, "unit of the derivative by each number");
  names("force_external", a.force_external, "plate:external that may carry a force");
  names("displacement_external", a.displacement_external, "plate:external with a given displacement");
  names("gap_hole", a.gap_hole, "plate:hole, each with springs that push but do not pull");
  names("peak/hole", a.peak_hole, "plate:hole whose peak hoop stress is differentiated at the last increment");
  const Eigen::Index steps = std::ssize(a.F), r = std::ssize(a.peak_hole);
  for (const auto& [by, meaning, dimension, count, first] : a.kinds) {
    const auto part = [&, from = first, size = count](const Eigen::MatrixXd& all) -> Eigen::MatrixXd {
      return all.middleCols(from, size);
    };
    std::vector<Eigen::MatrixXd> of_F;
    for (const auto& each : a.F) of_F.push_back(part(each));
    const bool is_one = std::string(by) == "load_factor", is_law = dimension.text != nullptr;
    file(group + by, of_F, is_one ? h5::Shape{steps, n} : h5::Shape{steps, n, count},
         is_law ? dimension.text : unit(units, -dimension.length, 1 - dimension.force), std::string("dF by ") + meaning,
         h5::infinite_too);
    file(group + "peak/" + by, part(a.peak), is_one ? h5::Shape{r} : h5::Shape{r, count},
         is_law ? std::string(dimension.text) + "/" + unit(units, 2, 0)
                : unit(units, -2 - dimension.length, 1 - dimension.force),
         std::string("dpeak by ") + meaning, h5::infinite_too);
  }
}

/// Writes largest and smallest values and the rows where they stand.
/// @param rows Extremes or what is derived from them. @param meanings Of the largest and of the smallest value.
template <class Rows>
void write_extremes(h5::Writer& file, const std::string& group, const Rows& rows, const std::string& unit,
                    const std::array<const char*, 2>& meanings, Eigen::Index steps) {
  const Eigen::Index k = std::ssize(rows);
  const h5::Allowed row = h5::integers(0, int(steps) - 1);
  file(group + "largest", Column{rows, &Extremes::largest}, {k}, unit, meanings[0], h5::infinite_too);
  file(group + "largest_at", Column{rows, &Extremes::largest_at}, {k}, "1", "row where it stands", row);
  file(group + "smallest", Column{rows, &Extremes::smallest}, {k}, unit, meanings[1], h5::infinite_too);
  file(group + "smallest_at", Column{rows, &Extremes::smallest_at}, {k}, "1", "row where it stands", row);
}

void write_envelope(h5::Writer& file, const std::vector<EnvelopeTable>& all, Eigen::Index steps) {
  file("envelope/quantity", Column{all, &EnvelopeTable::quantity}, {any}, "1",
       "quantities of the envelope, each with a group; none if the joint has no cases");
  for (const auto& [quantity, unit, rows] : all) {
    const std::string group = "envelope/" + quantity + "/";
    file(group + "of", Column{rows, &Extremes::of}, {any}, "1", "shear plane, plate:hole, plate:external or plate:tip");
    write_extremes(file, group, rows, unit, {"largest value over all increments of all cases", "smallest value"},
                   steps);
  }
}

void write_margins(h5::Writer& file, const std::vector<Margin>& a, Eigen::Index steps) {
  using M = Margin;
  const Eigen::Index m = std::ssize(a);
  const auto column = [&](const char* name, auto member, const std::string& unit, const char* meaning,
                          const h5::Allowed& allowed = {}) {
    file(std::string("margin/") + name, Column{a, member}, {m}, unit, meaning, allowed);
  };
  column("check", &M::check, "1", "check of each margin, the smallest margin first");
  column("of", &M::of, "1", "shear plane, or plate:hole");
  column("margin", &M::margin, "1", "allowable / (FS FF applied) - 1; infinite where nothing is applied",
         h5::infinite_too);
  column("allowable", &M::allowable, "1", "allowable load or stress", h5::infinite_too);
  column("applied", &M::applied, "1", "applied load or stress", h5::infinite_too);
  column("edge_ratio", &M::edge_ratio, "1",
         "distance of the hole's centre from the edge along its load over its diameter; infinite if it plays no part",
         h5::infinite_too);
  column("direction", &M::direction, "deg",
         "direction of the applied load or stress, counter-clockwise from x; infinite if it plays no part",
         h5::infinite_too);
  column("at", &M::at, "1", "row of the increment that governs", h5::integers(0, int(steps) - 1));
  column("unit", &M::unit, "1", "unit of the allowable and of what is applied");
  column("formula", &M::formula, "1", "formula of the allowable");
  column("inputs", &M::inputs, "1", "its numbers and the factors");
}

void write_stress_ranges(h5::Writer& file, const std::vector<StressRange>& a, Eigen::Index steps, const Units& units) {
  const std::string stress = unit(units, -2, 1), group = "stress_range/";
  const Eigen::Index r = std::ssize(a);
  file(group + "of", Column{a, &Extremes::of}, {any}, "1",
       "plate:hole with a known hoop stress, that with the largest range first");
  file(group + "angle", Column{a, &StressRange::angle}, {r}, "deg",
       "spot of its rim at which the hoop stress varies most over all increments, counter-clockwise from x");
  file(group + "range", Column{a, &StressRange::range}, {r}, stress, "largest less smallest hoop stress there");
  file(group + "error", Column{a, &StressRange::error}, {r}, stress,
       "estimated error of it: the sum of those of the hole's peaks at both increments", h5::infinite_too);
  write_extremes(file, group, a, stress, {"largest hoop stress there", "smallest hoop stress there"}, steps);
}

/// What the file says of the whole joint, for both directions.
template <class File, class Result>
void increment_datasets(File& file, Result& a) {
  header(file, a.header);
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
  file("plate/name", Column{a.plates, &PlateHistory::name}, {any}, "1",
       "plates of the joint; group plates/<name> has the results of each");
  const Eigen::Index plates = a.plates.size();
  file("plate/materials", Column{a.plates, &PlateHistory::materials}, {plates}, "1",
       "JSON text of \"materials\" in each PLATE.json, empty if unknown", h5::or_else(""));
  file("plate/matrices_digest", Column{a.plates, &PlateHistory::matrices_digest}, {plates}, "1",
       "digest of the MATRICES.h5 of each plate, empty if it has none", h5::or_else(""));
  file("plate/plate_digest", Column{a.plates, &PlateHistory::plate_digest}, {plates}, "1",
       "digest of the PLATE.h5 that the matrices of each plate were extracted from", h5::or_else(""));
  for (auto& plate : a.plates) case_datasets(file, "plates/" + plate.name + "/", plate, a.header.units);
}

void write_joint(h5::Writer& file, const JointResult& a) {
  const Eigen::Index steps = a.load_factor.size(), n = std::ssize(a.fastener_id);
  file("warning/code", a.warning_code, {any}, "1", "warnings, as stage3_nonlinear printed them");
  file("warning/text", a.warning, {std::ssize(a.warning_code)}, "1", "text of each");
  file("converged", a.converged, {steps}, "1", "1 where the increment converged");
  file("iterations", a.iterations, {steps}, "1", "iterations of the nonlinear solver, failed tries included");
  file("residual", a.residual, {steps}, "1",
       "largest residual, relative to the largest force that rigid fasteners carry");
  file("event", a.event, {steps}, "1",
       "fasteners that close, open, slip or yield at exactly this load factor, and events of rims in contact up to it");
  file("fastener/id", a.fastener_id, {n}, "1", "fastener of each shear plane, in the order of the input");
  file("fastener/first", a.first_hole, {n}, "1", "plate:hole on its first side");
  file("fastener/second", a.second_hole, {n}, "1", "plate:hole on its second side, or ground");
  file("direction", a.direction, {any}, "1", "directions of the discs");
  file("stiffness/external", a.load_external, {any}, "1", "plate:external of each load other than zero");
  columns::write(file, "", a.columns, a.header.units);
  write_envelope(file, a.envelope, steps);
  if (!a.margins.empty()) write_margins(file, a.margins, steps);
  if (!a.stress_ranges.empty()) write_stress_ranges(file, a.stress_ranges, steps, a.header.units);
  if (a.sensitivity) write_sensitivity(file, *a.sensitivity, n, a.header.units);
}

}  // namespace

std::vector<std::string> PlateHistory::names(Of of) const {
  const auto named = [](const auto& list, auto member) {
    std::vector<std::string> names;
    for (const auto& each : list) names.push_back(each.*member);
    return names;
  };
  switch (of) {
    case Of::hole:
      return holes.hole;
    case Of::external:
      return external_id;
    case Of::tip:
      return named(tips, &pfem::CrackTip::id);
    case Of::contact:
      return named(contact, &ContactRim::hole);
    default:
      throw std::logic_error("things without names cannot stand in an envelope or a study");
  }
}

void write(const std::string& path, const JointResult& a) {
  h5::Writer file(path, result_format);
  increment_datasets(file, a);
  for (const auto& plate : a.plates) write_things(file, "plates/" + plate.name + "/", plate, a.header.units);
  write_joint(file, a);
  file.commit();
}

JointResult read_joint_result(const std::string& path) {
  h5::Reader file(path, result_format);
  JointResult a;
  increment_datasets(file, a);
  for (auto& plate : a.plates)
    read_columns(file, "plates/" + plate.name + "/", plate, a.load_factor.size(), a.header.units);
  return a;
}

}  // namespace fastjoint::formats
