// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace fastjoint::h5 {

/// What every dataset says of itself.
struct Meta {
  std::string unit;         ///< "1" if dimensionless
  std::string description;  ///< one sentence
};

/// An HDF5 file that is built in memory and appears whole or not at all (commit).
///
/// Groups on the way to a dataset are made as needed. Equal calls give equal bytes. Arrays are row-major in
/// the file: a matrix A is stored with shape (rows, cols). Throws NumericalError for a NaN, FileError for the rest.
class Writer {
 public:
  Writer(std::string path, const std::string& format, int major, int minor);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void attribute(const std::string& name, const std::string& text);
  void attribute(const std::string& name, int value);

  void write(const std::string& dataset, const Eigen::VectorXd& v, const Meta& meta);
  void write(const std::string& dataset, const Eigen::MatrixXd& A, const Meta& meta);
  void write(const std::string& dataset, const Eigen::VectorXi& v, const Meta& meta);
  void write(const std::string& dataset, const Eigen::MatrixXi& A, const Meta& meta);
  void write(const std::string& dataset, const std::vector<std::string>& strings, const Meta& meta);
  void write(const std::string& dataset, const std::string& text, const Meta& meta);
  /// Stack of matrices of one shape (rows, cols), shape (n, rows, cols) in the file; n may be 0.
  void write(const std::string& dataset, const std::vector<Eigen::MatrixXd>& stack, Eigen::Index rows,
             Eigen::Index cols, const Meta& meta);
  /// A^T without copying it: Eigen's columns are the file's rows, shape (cols, rows).
  void write_transposed(const std::string& dataset, const Eigen::MatrixXd& A, const Meta& meta);

  /// Flushes, puts the file at its path and returns its digest.
  std::string commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fastjoint::h5
