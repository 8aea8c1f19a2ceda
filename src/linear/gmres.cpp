#include "linear/gmres.hpp"

#include <algorithm>
#include <cmath>

#include "space/wave_speed.hpp"

namespace alphadot {

namespace {
/// Share of the preconditioned residual that a step of Newton's method leaves to the next one.
constexpr Real left_over = 0.05;
}  // namespace

Gmres::Gmres(const Discretization& discretization, const Communicator& comm, const Residual& residual,
             LinearSolver& inside, int directions)
    : discretization_(discretization),
      comm_(comm),
      residual_(residual),
      inside_(inside),
      space_(static_cast<std::size_t>(discretization.domain().owned_cells), directions,
             [this](std::vector<Real>& numbers) { comm_.sum(numbers); }),
      defect_(static_cast<std::size_t>(discretization.domain().owned_cells)),
      image_(defect_.size()),
      product_(defect_.size()) {}

void Gmres::linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                      const TimeTerms& time) {
  inside_.linearise(flow, conditions, time);
  tangent_.reset();
  linearisation_.emplace(discretization_, comm_, flow, residual_.reconstruction(), conditions);
  tangent_.emplace(*linearisation_, Vec3{});
  time_scale_ = wave_speeds(discretization_, flow, conditions);
  for (std::size_t cell = 0; cell < time_scale_.size(); ++cell)
    time_scale_[cell] =
        time_scale_[cell] / time.cfl + discretization_.domain().volume[cell] * time.inverse_step;
}

void Gmres::apply(std::span<const Primitive<Real>> direction, std::span<Conserved<Real>> out) {
  tangent_->apply({direction}, {}, {out});
  for (std::size_t cell = 0; cell < out.size(); ++cell)
    out[cell] += time_scale_[cell] * conserved_change(linearisation_->flow()[static_cast<Index>(cell)],
                                                      direction[cell], discretization_.gamma());
}

void Gmres::solve_one(const LinearSystem& system) {
  std::ranges::fill(system.update, Primitive<Real>{});
  const LinearSystem first{system.residual, defect_};
  inside_.solve({&first, 1});
  space_.clear();
  const Real target = left_over * std::sqrt(comm_.sum(square(defect_)));
  KrylovBasis<Real>::System search{defect_, {}, {}, 0};
  do {
    apply(defect_, product_);
    const LinearSystem next{product_, image_};
    inside_.solve({&next, 1});
    const KrylovBasis<Real>::Candidate candidate{defect_, image_, {}};
    const int before = space_.size();
    space_.add({&candidate, 1});
    if (space_.size() == before) break;  // the space holds all that the preconditioner can find
    space_.reduce({&search, 1});
  } while (search.norm > target && !space_.is_full());
  space_.move(system.update, search.coefficients);
}

void Gmres::solve(std::span<const LinearSystem> systems) {
  for (const auto& system : systems) solve_one(system);
}

std::size_t Gmres::bytes() const {
  return space_.bytes() + (linearisation_ ? linearisation_->bytes() : 0) +
         (tangent_ ? tangent_->bytes() : 0) + time_scale_.size() * sizeof(Real) +
         3 * defect_.size() * sizeof(Primitive<Real>);
}

}  // namespace alphadot
