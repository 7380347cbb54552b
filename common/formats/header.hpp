// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/rim/elastic_disk.hpp"
#include "common/rim/harmonics.hpp"
#include "common/units.hpp"

namespace fastjoint::formats {

// Every format is one function template `datasets(file, a)`, which an h5::Writer and an h5::Reader go through line by
// line: each line has the name of a dataset, its place in memory, shape, unit and meaning, and what a reader allows.

/// The words of every file about itself.
struct Header {
  std::string generator;  ///< program and version
  std::string name;       ///< of the plate or joint
  Units units;
  std::string input;     ///< JSON text that it came from
  std::string digest{};  ///< of the file that this was read from; empty if that carries none
};

/// A rim whose springs push but do not pull, and the pressures that contact may add there.
struct ContactRim {
  std::string hole;
  rim::Harmonics pressures;
  double modulus;           ///< K of the springs, force / length^3
  double radius;            ///< length
  double area;              ///< thickness times length of the rim that the model has, length^2
  rim::ElasticDisk disk{};  ///< that presses in place of the springs; none: the springs do
};

/// A rim with waves that the finite elements carry: its displacements, and of contact its tractions too.
struct WaveRim {
  std::string hole;
  rim::Harmonics waves;
  double radius;   ///< length
  double area;     ///< thickness times length of the rim that the model has, length^2
  double modulus;  ///< K of the springs, 0 of an open hole, force / length^3
  /// Strains (x, y, xy) of the sheet at the rim by its stresses, 1 / stress; 0 where no closed form holds, as it is not
  /// the same all around, or the rim is not a whole one or a part between lines of symmetry.
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Zero();
  std::vector<rim::AngleRange> acts{};  ///< the sprung parts of the rim

  [[nodiscard]] bool has_closed_form() const { return compliance(0, 0) > 0; }
  /// Number of pressures, then shears.
  [[nodiscard]] Eigen::Index size() const { return waves.size() + waves.n_shears(); }
};

/// Waves of a rim of contact by which fields are made: elements hardly follow shorter ones.
[[nodiscard]] inline rim::Harmonics waves_of_field(const ContactRim& rim, const WaveRim& carried) {
  constexpr int hardly_followed = 16;
  rim::Harmonics waves = rim.pressures;
  waves.highest = std::min(waves.highest, std::max(carried.waves.highest, hardly_followed));
  return waves;
}

/// A plate with its degrees and unit cases, as PLATE.h5 and MATRICES.h5 both have it: np degrees, e rigid externals,
/// m discs (hole x direction), k loaded waves (rim of contact; pressures, then shears), h friction cases (hole,
/// direction, bearing + then -) of other holes, q tractions.
struct UnitCases {
  Header header;
  pfem::Space space = pfem::Space::trunk;                    ///< of a plate of finite elements
  Eigen::VectorXi p, ndof;                                   ///< (np)
  std::vector<std::string> disc_hole, disc_direction;        ///< (m)
  std::vector<std::string> external_id, external_direction;  ///< (e); "x" or "y"
  /// (q); a load in a hole has a case for each side that the model has, both of a unit force along the direction, and
  /// its negative force is of the second.
  std::vector<std::string> traction_id, traction_direction;
  std::vector<std::string> traction_bearing;  ///< (q) side of the hole that bears, "+x", ...; "" of edges
  std::vector<std::string> traction_hole{};   ///< (q) that a cosine pressure loads, "" for an edge
  std::vector<ContactRim> contact{};          ///< in the order of the holes
  std::vector<WaveRim> waves{};               ///< those of `contact`, then others in the order of the holes
  std::vector<std::string> friction_hole;     ///< (h)
  std::vector<std::string> friction_bearing;  ///< (h) "+x", "-x", "+y", "-y"

  [[nodiscard]] Eigen::Index n_externals() const { return external_id.size(); }
  [[nodiscard]] Eigen::Index n_discs() const { return disc_hole.size(); }
  /// Number of waves of the first rims of `waves`.
  [[nodiscard]] Eigen::Index n_waves_before(Eigen::Index rim) const {
    return std::accumulate(waves.begin(), waves.begin() + rim, Eigen::Index{0},
                           [](Eigen::Index sum, const WaveRim& each) { return sum + each.size(); });
  }
  /// k: number of waves of rims of contact, and of all rims.
  [[nodiscard]] Eigen::Index n_loaded_waves() const { return n_waves_before(std::ssize(contact)); }
  [[nodiscard]] Eigen::Index n_waves() const { return n_waves_before(std::ssize(waves)); }
  [[nodiscard]] Eigen::Index n_friction_cases() const { return friction_hole.size(); }
  [[nodiscard]] Eigen::Index n_tractions() const { return traction_id.size(); }
  /// Unit cases in their order: externals, discs, loaded waves, friction, tractions.
  [[nodiscard]] Eigen::Index n_cases() const {
    return n_externals() + n_discs() + n_loaded_waves() + n_friction_cases() + n_tractions();
  }
};

/// @tparam File An h5::Writer and a const Header, or an h5::Reader and a Header. Units are then compared only if the
/// file labels its own.
template <class File, class AnyHeader>
void header(File& file, AnyHeader& a);

/// The root attribute `space`, without which a file stays as it is. Throws FileError for a word that names no space.
template <class File, class AnySpace>
void space(File& file, AnySpace& a);

/// The datasets of UnitCases::contact, in a group whose name ends with "/", or in the root.
template <class File, class Contact>
void contact_datasets(File& file, Contact& a, const Units& units, const std::string& group = "");

/// The datasets of UnitCases::waves.
template <class File, class Waves>
void wave_datasets(File& file, Waves& a, const Units& units);

/// Number of degrees, the highest ones, at which waves that nothing loads and section forces are carried: their
/// difference estimates errors.
inline constexpr Eigen::Index n_stress_degrees = 2;

/// Names of the sides of a hole.
inline const std::vector<std::string> side_names = {"+x", "-x", "+y", "-y"};

/// What traction/bearing of every file is.
inline constexpr const char* bearing_side =
    "side of the hole that bears, +x, -x, +y or -y, for each traction in a hole, empty for an edge";

/// Names of the sides that bear of tractions, "" for one on an edge and where a file has none.
[[nodiscard]] h5::Allowed traction_sides();

/// Degrees from 1 to `highest`, each above the one before.
[[nodiscard]] h5::Allowed degrees(int highest);

}  // namespace fastjoint::formats
