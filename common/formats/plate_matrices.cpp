// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_matrices.hpp"

#include <fmt/format.h>

#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

using h5::any;
using h5::Column;
using h5::or_else;

const h5::Format matrices_format{"plate-matrices", 1, 15};
constexpr const char* per_case = "per unit of the case";
const h5::Allowed or_none = h5::Allowed{.text = "numbers >= 0", .low = 0}.or_else(0);

template <class File, class Matrices>
void name_datasets(File& file, Matrices& a) {
  unit_case_datasets(file, a, nullptr);
  file("disc/modulus", a.disc_modulus, {a.n_discs()}, unit(a.header.units, -3, 1),
       "modulus of the distributed springs between disc and sheet, 0 where there are none", or_none);
  h5::Allowed axis = h5::one_of({"x", "y"});
  axis.word = "";
  file("unsupported", a.unsupported, {any}, "1",
       "directions along which no support fixes the plate: the forces on it are in balance there", axis);
}

template <class File, class Matrices>
void matrix_datasets(File& file, Matrices& a) {
  const Units& units = a.header.units;
  const std::string area = unit(units, 2, 0), stiffness = unit(units, -1, 1);
  const auto n_p = a.p.size(), e = a.n_externals(), m = a.n_discs(), h = a.n_friction_cases(), q = a.n_tractions();
  const h5::Allowed error = h5::not_negative.or_else(h5::infinite);
  file("friction/unit_force", a.friction_unit_force, {h}, area, "bearing force per unit peak contact stress");
  file("traction/unit_force", a.traction_unit_force, {q}, area,
       "force per unit peak of the cosine pressure in a hole, 0 for an edge", or_else(0));
  file("friction/resultant", a.friction_resultant, {h}, area,
       "resultant along the direction of a unit friction case, signed");
  const auto across = [&](const char* path, auto& list, Eigen::Index n, const std::string& its_unit, const char* text) {
    if constexpr (File::reads)
      file(path, list, {n}, its_unit, text, or_else(0));
    else
      file(path, list.size() == 0 ? Eigen::VectorXd::Zero(n).eval() : list, {n}, its_unit, text);
  };
  across("friction/resultant_across", a.friction_resultant_across, h, area,
         "resultant of a unit friction case along + the other axis");
  across("traction/resultant_across", a.traction_resultant_across, q, "1",
         "force along + the other axis per unit total force on each traction boundary");
  file("S_ee", a.S_ee, {n_p, e, e}, stiffness, "force on external i per displacement of external j");
  file("S_ed", a.S_ed, {n_p, e, m}, stiffness, "force on external i per displacement of disc j");
  file("S_dd", a.S_dd, {n_p, m, m}, stiffness, "force on disc i per displacement of disc j");
  file("S_ee_error", a.S_ee_error, {e, e}, stiffness, "estimated absolute error of S_ee at the highest p", error);
  file("S_ed_error", a.S_ed_error, {e, m}, stiffness, "estimated absolute error of S_ed at the highest p", error);
  file("S_dd_error", a.S_dd_error, {m, m}, stiffness, "estimated absolute error of S_dd at the highest p", error);
  file("R_ef", a.R_ef, {n_p, e, h}, area, "reaction force on external i per unit friction case j");
  file("R_df", a.R_df, {n_p, m, h}, area, "reaction force on disc i per unit friction case j");
  file("T_d", a.T_d, {n_p, m, q}, "1", "reaction force on disc i per unit total force on traction boundary j");
  file("T_e", a.T_e, {n_p, e, q}, "1", "reaction force on external i per unit total force on traction boundary j");
  file("C_t", a.C_t, {n_p, q, q}, unit(units, 1, -1),
       "mean displacement of traction boundary i per unit total force on j, with all controlled displacements fixed");
  file("W", a.W, {n_p, a.n_loaded_waves(), a.n_cases()}, per_case,
       "integral over the rim of the disc's displacement relative to the sheet times the distribution of each wave of "
       "contact, normal for pressures and tangential for shears, in each unit case");
}

template <class File, class Stresses>
void stress_datasets(File& file, Stresses& a, Eigen::Index n_waves, Eigen::Index all_cases, const Units& units) {
  const std::string length = unit(units, 1, 0), area = unit(units, 2, 0);
  file("stress/p", a.p, {any}, "1", "degrees of the stresses and section forces", degrees(highest_degree).or_else(0));
  file("rim/hole", a.rim_hole, {any}, "1", "holes, open ones included", or_else(""));
  const Eigen::Index l = a.p.size(), r = a.rim_hole.size();
  if (File::reads && l == 0 && r == 0) return;
  file("rim/center", a.rim_center, {r, 2}, length, "x and y of each hole's centre");
  file("rim/radius", a.rim_radius, {r}, length, "radius of each hole", h5::positive);
  file("rim/thickness", a.rim_thickness, {r}, length, "mean thickness of the sheet at the rim", or_none);
  file("rim/modulus", a.rim_modulus, {r, 2}, unit(units, -2, 1),
       "mean modulus in tension of the sheet at the rim, along x and along y", or_none);
  file("rim/bearing_area", a.bearing_area, {r, 2}, area, "projected area of the rim for bearing along x and along y",
       h5::positive);
  const Eigen::Index n_cases = l > 0 ? all_cases : 0;
  file("rim/W", a.other_waves, {l, l > 0 ? n_waves : 0, n_cases}, per_case,
       "the same as W, of the waves of other holes");
  file("section/hole", a.section_hole, {any}, "1", "hole that each section is next to", or_else(""));
  const Eigen::Index s = a.section_hole.size();
  file("section/side", a.section_side, {s}, "1", "side of the hole that each section lies on", h5::one_of(side_names));
  file("section/gross_area", a.gross_area, {s}, area, "area of each section", h5::positive);
  file("section/net_area", a.net_area, {s}, area,
       "area of each section less the projected areas of the hole and of cracks in its cell", h5::not_negative);
  file("section/force", a.section_force, {l, s, n_cases}, per_case,
       "normal force over the section in each unit case, tension positive");
  file("section/shear", a.section_shear, {l, s, n_cases}, per_case,
       "shear force over the section in each unit case, positive where the shear stress xy is",
       h5::infinite_too.or_else(h5::infinite));
  file("section/stiffness_error", a.stiffness_error, {l}, "1",
       "estimated relative error of S and C_t at each degree of stress/p, infinite at the plate's lowest",
       h5::not_negative.or_else(0));
}

template <class File, class Cracks>
void crack_datasets(File& file, Cracks& a, Eigen::Index n_p, Eigen::Index n_cases, const Units& units) {
  tip_datasets(file, a.tips, units);
  const Eigen::Index t = std::ssize(a.tips);
  if (File::reads && t == 0) return;
  file("crack/K_I", a.K_I, {n_p, t, n_cases}, per_case,
       "stress intensity factor of the opening mode at each tip in each unit case");
  file("crack/K_II", a.K_II, {n_p, t, n_cases}, per_case, "the same of the sliding mode");
}

template <class File, class Matrices>
void matrices_datasets(File& file, Matrices& a) {
  header(file, a.header);
  file.attribute("plate_digest", a.plate_digest);
  name_datasets(file, a);
  matrix_datasets(file, a);
  stress_datasets(file, a.stresses, a.n_waves() - a.n_loaded_waves(), a.n_cases(), a.header.units);
  crack_datasets(file, a.cracks, a.p.size(), a.n_cases(), a.header.units);
}

}  // namespace

std::string write(const std::string& path, const PlateMatrices& a) {
  h5::Writer file(path, matrices_format);
  matrices_datasets(file, a);
  return file.commit();
}

PlateMatrices read_plate_matrices(const std::string& path) {
  h5::Reader file(path, matrices_format);
  if (file.has("rim/sigma_tt") || file.has("B_d"))
    throw FileError(
        fmt::format("{}: was written before version 1.8, with stresses at points; run stage1_plate and "
                    "stage2_extract again",
                    path));
  PlateMatrices a;
  matrices_datasets(file, a);
  return a;
}

UnitCases read_unit_cases(const std::string& path) {
  h5::Reader file(path, matrices_format);
  UnitCases a;
  header(file, a.header);
  unit_case_datasets(file, a, nullptr);
  return a;
}

}  // namespace fastjoint::formats
