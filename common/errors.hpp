// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>

namespace fastjoint {

/// An invalid option, JSON input, mesh or joint: exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written, is damaged, or is of the wrong kind or version: exit status 3.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A singular or indefinite system, or no convergence: exit status 4.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A numerical error after the converged part of the result has been written and summarised.
struct IncompleteResult : NumericalError {
  using NumericalError::NumericalError;
};

}  // namespace fastjoint
