// The ranks of a run: a thin owner of an MPI communicator with the few collectives the solver uses.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Initialises MPI for the life of the object. Create one in main, before anything else.
class MpiSession {
 public:
  MpiSession(int& argc, char**& argv);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
};

/// Items of `bytes` bytes each as MPI counts them, so that 2^31 of them fit into a message. The type is given
/// up with the object; requests that were made with it keep it.
class ByteItem {
 public:
  explicit ByteItem(std::size_t bytes);
  ~ByteItem() { MPI_Type_free(&type_); }
  ByteItem(const ByteItem&) = delete;
  ByteItem& operator=(const ByteItem&) = delete;

  MPI_Datatype type() const { return type_; }

 private:
  MPI_Datatype type_;
};

/// A group of ranks. Copies share the underlying communicator; the world communicator outlives them.
class Communicator {
 public:
  explicit Communicator(MPI_Comm comm = MPI_COMM_WORLD);

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_root() const { return rank_ == 0; }
  MPI_Comm handle() const { return comm_; }

  void barrier() const;
  /// In place over all ranks; one message for the whole buffer.
  void sum(std::span<Real> values) const;
  void sum(std::span<GlobalIndex> values) const;
  void max(std::span<Real> values) const;
  void min(std::span<Real> values) const;
  Real sum(Real value) const;
  GlobalIndex sum(GlobalIndex value) const;
  Real max(Real value) const;
  Real min(Real value) const;
  /// True when any rank says so.
  bool any(bool value) const;
  /// Text of `root` on every rank.
  std::string broadcast(const std::string& text, int root = 0) const;
  /// Bytes of `root` on every rank; `bytes` has the same size everywhere. Any size (split above 1 GiB).
  void broadcast(std::span<std::byte> bytes, int root = 0) const;

  /// Runs `work` on the root alone. What is thrown there is thrown on every rank as on_all does, so that no
  /// rank waits for another one that has failed. Collective.
  void on_root(const std::function<void()>& work) const;
  /// Runs `work` on every rank; when it throws on any, every rank throws the first rank's error. Errors of
  /// the input and of the system, and memory that does not suffice, become InputErrors; any other exception
  /// is a fault of the program, which goes on as it is where it was thrown and as FailedElsewhere on other
  /// ranks. Collective: `work` itself must not communicate.
  void on_all(const std::function<void()>& work) const;

 private:
  MPI_Comm comm_;
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace alphadot
