// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field.hpp"

#include <fmt/format.h>

namespace fastjoint::stage2 {
namespace {

using Eigen::Index;

constexpr int lagrange_quadrilateral = 70;  // VTK_LAGRANGE_QUADRILATERAL

constexpr const char* description =
    "<!-- One state of a sheet by stage2_extract. Points are not shared between elements, so jumps of the stress stay\n"
    "     visible. von_mises is that of the stresses in the plane, with sigma_z = 0. principal_1 is the larger of the\n"
    "     principal stresses in the plane. thickness belongs to cells; hole_* and the labels of the units are in\n"
    "     FieldData, text as the codes of its bytes. -->\n";

/// Adds an array of numbers; vectors in the plane get a third component of 0, as VTK requires.
/// @param shape Attributes with the numbers of components and tuples.
void add_array(std::string& text, const char* name, const std::string& shape, const Eigen::MatrixXd& values) {
  text += fmt::format("<DataArray type=\"Float64\" Name=\"{}\" {} format=\"ascii\">\n", name, shape);
  for (Index i = 0; i < values.cols(); ++i)
    text += values.rows() == 2 ? fmt::format("{:.9g} {:.9g} 0\n", values(0, i), values(1, i))
                               : fmt::format("{:.9g}\n", values(0, i));
  text += "</DataArray>\n";
}

void add_points(std::string& text, const char* name, const Eigen::MatrixXd& values) {
  add_array(text, name, fmt::format("NumberOfComponents=\"{}\"", values.rows() == 2 ? 3 : 1), values);
}

/// Adds strings as the codes of their bytes, each string ended by 0. So no character can break the XML, and meshio,
/// which does not support arrays of strings, reads them too.
void add_strings(std::string& text, const char* name, const std::vector<std::string>& values) {
  std::string bytes;
  for (const auto& value : values) bytes += value + '\0';
  text += fmt::format("<DataArray type=\"UInt8\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">\n", name,
                      bytes.size());
  for (const char c : bytes) text += fmt::format("{} ", int{static_cast<unsigned char>(c)});
  text += "</DataArray>\n";
}

void add_integer(std::string& text, const char* name, int value) {
  text += fmt::format("<DataArray type=\"Int32\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n",
                      name, value);
}

void add_holes(std::string& text, const formats::PlateSolution& plate) {
  add_strings(text, "hole_id", plate.hole_id);
  Eigen::Matrix3Xd holes(3, plate.hole_rim.size());
  for (Index i = 0; i < holes.cols(); ++i) holes.col(i) << plate.hole_rim[i].center, plate.hole_rim[i].radius;
  const auto tuples = fmt::format("NumberOfTuples=\"{}\"", holes.cols());
  add_array(text, "hole_center", "NumberOfComponents=\"3\" " + tuples, holes.topRows<2>());
  add_array(text, "hole_radius", tuples, holes.row(2));
}

void add_field_data(std::string& text, const formats::PlateSolution& plate, const FieldState& state, int p) {
  const auto& units = plate.header.units;
  text += "<FieldData>\n";
  add_strings(text, "plate", {plate.header.name});
  add_strings(text, "state", {state.words});
  add_strings(text, "length_unit", {unit(units, 1, 0)});
  add_strings(text, "stress_unit", {unit(units, -2, 1)});
  add_integer(text, "degree", p);
  if (state.increment != 0) {
    add_strings(text, "joint_plate", {state.joint_plate});
    add_integer(text, "increment", state.increment);
  }
  if (!plate.hole_id.empty()) add_holes(text, plate);
  text += "</FieldData>\n";
}

void add_cells(std::string& text, Index n_cells, Index n_nodes) {
  text += "<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
  for (Index i = 0; i < n_cells * n_nodes; ++i) text += fmt::format("{}{}", i, (i + 1) % n_nodes == 0 ? '\n' : ' ');
  text += "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
  for (Index i = 1; i <= n_cells; ++i) text += fmt::format("{}\n", i * n_nodes);
  text += "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n";
  for (Index i = 0; i < n_cells; ++i) text += fmt::format("{}\n", lagrange_quadrilateral);
  text += "</DataArray>\n</Cells>\n";
}

void add_point_data(std::string& text, const Field& field) {
  text += "<PointData Scalars=\"von_mises\" Vectors=\"displacement\">\n";
  add_points(text, "displacement", field.displacement);
  add_points(text, "stress_xx", field.stress.row(0));
  add_points(text, "stress_yy", field.stress.row(1));
  add_points(text, "stress_xy", field.stress.row(2));
  add_points(text, "von_mises", von_mises(field.stress).transpose());
  const Eigen::Matrix2Xd main = principal(field.stress);
  add_points(text, "principal_1", main.row(0));
  add_points(text, "principal_2", main.row(1));
  text += "</PointData>\n";
}

}  // namespace

std::string vtu(const formats::PlateSolution& plate, const FieldState& state, const Field& field) {
  const Index n_cells = plate.mesh.n_elements();
  const Index n_points = field.points.cols();
  std::string text;
  text += fmt::format("<?xml version=\"1.0\"?>\n{}", description);
  text += "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n";
  add_field_data(text, plate, state, field.p);
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", n_points, n_cells);
  add_point_data(text, field);
  text += "<CellData Scalars=\"thickness\">\n";
  add_points(text, "thickness", plate.mesh.thickness.transpose());
  text += "</CellData>\n<Points>\n";
  add_points(text, "points", field.points);
  text += "</Points>\n";
  add_cells(text, n_cells, n_points / n_cells);
  text += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return text;
}

}  // namespace fastjoint::stage2
