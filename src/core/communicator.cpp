#include "core/communicator.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "core/error.hpp"

namespace alphadot {

MpiSession::MpiSession(int& argc, char**& argv) {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);  // other threads never call MPI
}

MpiSession::~MpiSession() {
  if (std::uncaught_exceptions() == 0) MPI_Finalize();
}

ByteItem::ByteItem(std::size_t bytes) {
  MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_);
  MPI_Type_commit(&type_);
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
  constexpr std::size_t chunk = std::size_t{1} << 30;
  for (std::size_t begin = 0; begin < values.size(); begin += chunk)
    MPI_Allreduce(MPI_IN_PLACE, values.data() + begin,
                  static_cast<int>(std::min(chunk, values.size() - begin)), type, op, comm);
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

/// What became of the work of one rank.
struct Failure {
  std::vector<Problem> problems;
  std::exception_ptr fault;  ///< of the program
};

Failure failure_of(const std::function<void()>& work, int rank) {
  try {
    work();
    return {};
  } catch (const InputError& error) {
    if (error.problems().empty()) return {{Problem{"", 0, "an error without a description", ""}}, {}};
    return {error.problems(), {}};
  } catch (const std::system_error& error) {
    return {{Problem{"", 0, error.what(), ""}}, {}};
  } catch (const std::bad_alloc&) {
    return {{out_of_memory(rank)}, {}};
  } catch (...) {
    return {{}, std::current_exception()};
  }
}

}  // namespace

void Communicator::on_root(const std::function<void()>& work) const {
  on_all([&] {
    if (is_root()) work();
  });
}

void Communicator::on_all(const std::function<void()>& work) const {
  auto [problems, fault] = failure_of(work, rank_);
  // The first rank with a fault, else the first with a problem.
  int failing_rank = fault ? rank_ - size_ : problems.empty() ? size_ : rank_;
  MPI_Allreduce(MPI_IN_PLACE, &failing_rank, 1, MPI_INT, MPI_MIN, comm_);
  if (fault) std::rethrow_exception(fault);
  if (failing_rank < 0) throw FailedElsewhere("rank " + std::to_string(failing_rank + size_) + " has failed");
  if (failing_rank < size_) throw_everywhere(*this, std::move(problems), failing_rank);
}

}  // namespace alphadot
