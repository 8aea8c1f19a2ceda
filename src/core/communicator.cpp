#include "core/communicator.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>

#include "core/error.hpp"

namespace alphadot {

MpiSession::MpiSession(int& argc, char**& argv) {
  MPI_Init(&argc, &argv);
}

MpiSession::~MpiSession() {
  if (std::uncaught_exceptions() == 0) MPI_Finalize();
}

Communicator::Communicator(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

void Communicator::barrier() const {
  MPI_Barrier(comm_);
}

namespace {
template <class T>
void reduce(MPI_Comm comm, std::span<T> values, MPI_Datatype type, MPI_Op op) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), type, op, comm);
}
}  // namespace

void Communicator::sum(std::span<Real> values) const {
  reduce(comm_, values, MPI_DOUBLE, MPI_SUM);
}
void Communicator::sum(std::span<GlobalIndex> values) const {
  reduce(comm_, values, MPI_INT64_T, MPI_SUM);
}
void Communicator::max(std::span<Real> values) const {
  reduce(comm_, values, MPI_DOUBLE, MPI_MAX);
}
void Communicator::min(std::span<Real> values) const {
  reduce(comm_, values, MPI_DOUBLE, MPI_MIN);
}

Real Communicator::sum(Real value) const {
  sum(std::span(&value, 1));
  return value;
}
GlobalIndex Communicator::sum(GlobalIndex value) const {
  sum(std::span(&value, 1));
  return value;
}
Real Communicator::max(Real value) const {
  max(std::span(&value, 1));
  return value;
}
Real Communicator::min(Real value) const {
  min(std::span(&value, 1));
  return value;
}
bool Communicator::any(bool value) const {
  return max(value ? 1.0 : 0.0) > 0;
}

void Communicator::broadcast(std::span<std::byte> bytes, int root) const {
  constexpr std::size_t chunk = std::size_t{1} << 30;
  for (std::size_t begin = 0; begin < bytes.size(); begin += chunk)
    MPI_Bcast(bytes.data() + begin, static_cast<int>(std::min(chunk, bytes.size() - begin)), MPI_BYTE, root,
              comm_);
}

std::string Communicator::broadcast(const std::string& text, int root) const {
  GlobalIndex size = static_cast<GlobalIndex>(text.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, root, comm_);
  std::string out = rank_ == root ? text : std::string(static_cast<std::size_t>(size), '\0');
  broadcast(std::as_writable_bytes(std::span(out)), root);
  return out;
}

namespace {

/// Sends the problems of `failing_rank` to every rank and throws them there.
[[noreturn]] void throw_everywhere(const Communicator& comm, std::vector<Problem> problems,
                                   int failing_rank) {
  GlobalIndex count = static_cast<GlobalIndex>(problems.size());
  MPI_Bcast(&count, 1, MPI_INT64_T, failing_rank, comm.handle());
  problems.resize(static_cast<std::size_t>(count));
  for (auto& problem : problems) {
    problem.file = comm.broadcast(problem.file, failing_rank);
    problem.what = comm.broadcast(problem.what, failing_rank);
    problem.remedy = comm.broadcast(problem.remedy, failing_rank);
    MPI_Bcast(&problem.line, 1, MPI_INT, failing_rank, comm.handle());
  }
  throw InputError(std::move(problems));
}

std::vector<Problem> problems_of(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const InputError& error) {
    if (error.problems().empty()) return {Problem{"", 0, "an error without a description", ""}};
    return error.problems();
  } catch (const std::exception& error) {
    return {Problem{"", 0, error.what(), ""}};
  }
}

}  // namespace

void Communicator::on_root(const std::function<void()>& work) const {
  on_all([&] {
    if (is_root()) work();
  });
}

void Communicator::on_all(const std::function<void()>& work) const {
  auto problems = problems_of(work);
  int failing_rank = problems.empty() ? size_ : rank_;
  MPI_Allreduce(MPI_IN_PLACE, &failing_rank, 1, MPI_INT, MPI_MIN, comm_);
  if (failing_rank < size_) throw_everywhere(*this, std::move(problems), failing_rank);
}

}  // namespace alphadot
