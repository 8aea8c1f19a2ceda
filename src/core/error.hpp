// Errors that a user can mend, and the way every rank learns of them.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace alphadot {

/// One thing wrong with the input: where it is, what is wrong and what to do about it.
struct Problem {
  std::string file;    ///< path as the user gave it; empty when no file is concerned
  int line = 0;        ///< 1-based; 0 when unknown or binary
  std::string what;    ///< what is wrong
  std::string remedy;  ///< what to do; may be empty

  /// "file:line: what; remedy"
  std::string text() const;
};

/// A mistake in the input or the environment. Thrown on all ranks before any collective call;
/// main prints every problem once and ends with exit code `ExitCode::error`.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  InputError(std::string file, int line, std::string what, std::string remedy = "");

  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Adds what is wrong in `look` to the problems.
template <class Look>
void collect(std::vector<Problem>& problems, const Look& look) {
  try {
    look();
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
}

/// Memory does not suffice, as an error that a user can mend.
Problem out_of_memory(int rank);

/// Thrown on the ranks that are well when a fault of the program ends another one.
class FailedElsewhere : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run cannot go on for a reason inside the flow: vacuum, NaN, residual growth that no CFL cut mends.
class DivergedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace alphadot
