// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace fastjoint::h5 {

/// Any extent will do.
inline constexpr Eigen::Index any = -1;

/// Whether a dataset may hold infinite numbers; a NaN never stands in a file.
enum class Infinite { refused, allowed };

/// An HDF5 file opened for reading, whose seal, kind and major version are checked before anything else.
///
/// Every read checks type class, rank, shape and unit and throws FileError with the file, the dataset, what was found
/// and what was expected. A dataset without `unit` is taken as it is (a laboratory's matrices need none),
/// and so is any where "" is expected.
class Reader {
 public:
  Reader(std::string path, const std::string& format, int major);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] const std::string& path() const;
  /// Digest that the file carries; empty if it has none.
  [[nodiscard]] const std::string& digest() const;
  [[nodiscard]] bool has(const std::string& dataset) const;
  /// Root attribute, or `otherwise` if the file has none of that name.
  [[nodiscard]] std::string attribute(const std::string& name, const std::string& otherwise) const;
  [[nodiscard]] int integer_attribute(const std::string& name) const;

  [[nodiscard]] Eigen::VectorXd vector(const std::string& dataset, Eigen::Index n, const std::string& unit) const;
  [[nodiscard]] Eigen::MatrixXd matrix(const std::string& dataset, Eigen::Index rows, Eigen::Index cols,
                                       const std::string& unit, Infinite infinite = Infinite::refused) const;
  /// Shape (n, rows, cols) as n matrices.
  [[nodiscard]] std::vector<Eigen::MatrixXd> stack(const std::string& dataset, Eigen::Index n, Eigen::Index rows,
                                                   Eigen::Index cols, const std::string& unit,
                                                   Infinite infinite = Infinite::refused) const;
  /// Inverse of Writer::write_transposed: a dataset of shape (cols, rows) as a matrix of (rows, cols).
  [[nodiscard]] Eigen::MatrixXd transposed(const std::string& dataset, Eigen::Index cols, Eigen::Index rows,
                                           const std::string& unit) const;
  [[nodiscard]] Eigen::VectorXi integers(const std::string& dataset, Eigen::Index n) const;
  [[nodiscard]] Eigen::MatrixXi integer_matrix(const std::string& dataset, Eigen::Index rows, Eigen::Index cols) const;
  [[nodiscard]] std::vector<std::string> strings(const std::string& dataset, Eigen::Index n) const;
  [[nodiscard]] std::string text(const std::string& dataset) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fastjoint::h5
