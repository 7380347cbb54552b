// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// What holes and cracks leave of the sections of a sheet.
class NetSections {
 public:
  NetSections(const formats::PlateSolution& plate, const pfem::Edges& edges);

  /// Area of a section less the projected areas of its hole and of the cracks in the hole's cell; 0 if nothing is left,
  /// length^2. Cracks count from the section to the same distance beyond the hole, within the section's ends.
  [[nodiscard]] double area(const rim::Section& section) const;

 private:
  /// One edge of a face of a crack.
  struct Face {
    Eigen::Vector2d from, to;
    double thickness;
  };
  const formats::PlateSolution& plate_;
  const pfem::Edges& edges_;
  std::vector<Face> faces_;  ///< of one of the two faces of each crack
};

}  // namespace fastjoint::stage2
