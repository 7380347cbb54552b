// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_solution.hpp"
#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"

namespace fastjoint::formats {

/// The part of PLATE.h5 that is shape and material: mesh, elasticity, holes with their springs, sections.
void write_geometry(h5::Writer& file, const PlateSolution& a);

/// Sets that part. Throws FileError for an index that names nothing.
void read_geometry(const h5::Reader& file, PlateSolution& a);

}  // namespace fastjoint::formats
