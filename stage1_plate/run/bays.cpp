// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "stage1_plate/run/solve.hpp"

namespace fastjoint::stage1 {
namespace {

/// What a line across an axis cuts of a sheet.
struct Cut {
  double width = 0;                                 ///< holes filled
  double sheet = 0;                                 ///< of that what is not hole
  double thickness = 0, membrane = 0, bending = 0;  ///< integrals over `sheet`
};

/// A sheet along one axis, 0 for x, 1 for y.
class Beam {
 public:
  Beam(const PlateScene& scene, const PlateMesh& plate, const formats::Border& border, int axis)
      : scene_(scene), plate_(plate), border_(border), axis_(axis) {
    const auto along = plate.mesh.nodes.row(axis);
    low_ = along.minCoeff(), high_ = along.maxCoeff();
  }

  /// Ends of the bays: those of the sheet, rows of discs, and where outline, thickness or material change along a line
  /// across the axis.
  [[nodiscard]] std::vector<double> ends(const formats::Places& places) const {
    std::vector<double> all{low_, high_};
    for (const double row : places.disc.col(axis_)) all.push_back(row);
    for (const auto& piece : border_)
      if (is_across(piece.from, piece.to)) all.push_back(piece.from[axis_]);
    const pfem::Mesh& mesh = plate_.mesh;
    for (int edge = 0; edge < plate_.edges.size(); ++edge) {
      const auto& sides = plate_.edges.sides[edge];
      if (sides.size() < 2) continue;
      const int a = sides[0].element, b = sides[1].element;
      if (mesh.thickness[a] == mesh.thickness[b] && mesh.material[a] == mesh.material[b]) continue;
      const Eigen::Vector2d from = mesh.nodes.col(plate_.edges.nodes(0, edge)),
                            to = mesh.nodes.col(plate_.edges.nodes(1, edge));
      if (is_across(from, to)) all.push_back(from[axis_]);
    }
    std::ranges::sort(all);
    std::vector<double> apart;
    for (const double each : all)
      if (apart.empty() || each - apart.back() > nearly()) apart.push_back(each);
    apart.back() = high_;
    return apart;
  }

  /// The bay between two coordinates, by cuts in its middle and beside its ends.
  [[nodiscard]] formats::Bay bay(double from, double to) const {
    constexpr int n = 5;
    formats::Bay its{axis_ == 0 ? "x" : "y", from, to, 0, 0, 0, 0};
    for (int i = 0; i < n; ++i) {
      const Cut cut = cut_at(from + (i + 0.5) / n * (to - from));
      its.width += cut.width / n;
      its.thickness += cut.thickness / cut.sheet / n;
      its.membrane += cut.width * cut.membrane / cut.sheet / n;
      its.bending += cut.width * cut.bending / cut.sheet / n;
    }
    its.held_from = from == low_ && is_held(low_);
    its.held_to = to == high_ && is_held(high_);
    return its;
  }

 private:
  [[nodiscard]] double nearly() const { return 1e-6 * (high_ - low_); }
  [[nodiscard]] bool is_across(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    return std::abs(from[axis_] - to[axis_]) < nearly();
  }
  /// True if a support or an external is on the end of the sheet at a coordinate.
  [[nodiscard]] bool is_held(double at) const {
    return std::ranges::any_of(border_, [&](const auto& piece) {
      return piece.is_free == 0 && is_across(piece.from, piece.to) && std::abs(piece.from[axis_] - at) < nearly();
    });
  }

  [[nodiscard]] Cut cut_at(double at) const {
    Cut cut;
    std::vector<double> found;
    const pfem::Mesh& mesh = plate_.mesh;
    for (int element = 0; element < mesh.n_elements(); ++element) {
      found.clear();
      for (int i = 0; i < 4; ++i) add_crossing({element, i}, at, found);
      if (found.size() < 2) continue;
      const auto [low, high] = std::ranges::minmax(found);
      const double length = high - low, t = mesh.thickness[element];
      const int material = mesh.material[element];
      cut.sheet += length;
      cut.thickness += length * t;
      cut.membrane += length * t / scene_.elasticity[material].inverse()(axis_, axis_);
      cut.bending += length * std::pow(t, 3) / 12 * scene_.in_bending[material](axis_, axis_);
    }
    cut.width = cut.sheet;
    for (const auto& rim : plate_.rims) {
      found.clear();
      for (const auto& side : rim.sides) add_crossing(side, at, found);
      if (found.size() == 1) found.push_back(rim.center[1 - axis_]);  // a line of symmetry cuts the hole
      if (found.size() == 2) cut.width += std::abs(found[1] - found[0]);
    }
    return cut;
  }

  /// Adds the coordinate across the axis at which a line across it meets the chord of a side.
  void add_crossing(const pfem::Side& side, double at, std::vector<double>& found) const {
    const auto& [element, i] = side;
    const auto a = plate_.mesh.nodes.col(plate_.mesh.quads(i, element)),
               b = plate_.mesh.nodes.col(plate_.mesh.quads((i + 1) % 4, element));
    if ((a[axis_] < at) == (b[axis_] < at)) return;
    const double share = (at - a[axis_]) / (b[axis_] - a[axis_]);
    found.push_back(a[1 - axis_] + share * (b[1 - axis_] - a[1 - axis_]));
  }

  const PlateScene& scene_;
  const PlateMesh& plate_;
  const formats::Border& border_;
  int axis_;
  double low_, high_;
};

}  // namespace

std::vector<formats::Bay> bays_of(const PlateScene& scene, const PlateMesh& plate, const formats::Border& border,
                                  const formats::Places& places) {
  std::vector<formats::Bay> bays;
  for (int axis = 0; axis < 2 && !scene.in_bending.empty(); ++axis) {
    const Beam beam(scene, plate, border, axis);
    const auto ends = beam.ends(places);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) bays.push_back(beam.bay(ends[i], ends[i + 1]));
  }
  return bays;
}

}  // namespace fastjoint::stage1
