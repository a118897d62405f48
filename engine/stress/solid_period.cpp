#include "engine/stress/solid_period.h"

#include <algorithm>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr int kMostSteps = 1500;
constexpr int kCheckEvery = 10;
constexpr double kLeastChange = 1e-3;  // of the frequency's square from check to check
constexpr int kQuietChecks = 3;        // so many in a row: it may dwell at a higher frequency for a while
constexpr int kRelieveEvery = 8;       // steps, both vectors: rounding lets rigid motions grow slowly

/// How many eigenvalues of the symmetric tridiagonal matrix are below `shift` (Sturm's count).
int count_below(const std::vector<double>& diagonal, const std::vector<double>& beside, double shift) {
  int count = 0;
  double pivot = 1.0;
  for (Size i = 0; i < diagonal.size(); ++i) {
    const double previous = i == 0 ? 0.0 : beside[i - 1] * beside[i - 1] / pivot;
    pivot = diagonal[i] - shift - previous;
    if (pivot == 0.0) pivot = -1e-300;
    if (pivot < 0.0) ++count;
  }
  return count;
}

double least_eigenvalue(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  double low = 0.0, high = *std::min_element(diagonal.begin(), diagonal.end());
  for (int i = 0; i < 60 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    (count_below(diagonal, beside, middle) > 0 ? high : low) = middle;
  }
  return high;
}

/// Entries of one vector of unknowns with fixed chunks.
class MassProduct {
 public:
  explicit MassProduct(const VecX& mass) : mass_(mass), partial_((at_size() + kGrain - 1) / kGrain) {}

  double operator()(const VecX& a, const VecX& b) {
    core::parallel_chunks(at_size(), kGrain, [&](Size begin, Size end) {
      double sum = 0.0;
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
        sum += mass_(i) * a(i) * b(i);
      partial_[begin / kGrain] = sum;
    });
    double sum = 0.0;
    for (const double part : partial_) sum += part;
    return sum;
  }

 private:
  static constexpr Size kGrain = 3 * kRowGrain;
  Size at_size() const { return static_cast<Size>(mass_.size()); }
  const VecX& mass_;
  std::vector<double> partial_;
};

}  // namespace

double lowest_frequency_squared(const BlockSystem& system, const VecX& mass, const RigidModes& rigid) {
  const Size rows = system.rows->size();
  // Within what the holds allow; one over the mass there.
  const auto restrict_and_divide = [&](VecX& x, bool divide) {
    core::parallel_for(rows, kRowGrain, [&](Size row) {
      const auto first = static_cast<Eigen::Index>(3 * row);
      if (!(mass(first) > 0.0) || system.rows->first[row] == system.rows->first[row + 1]) {
        x.segment<3>(first).setZero();
        return;
      }
      if (divide) x.segment<3>(first) /= mass(first);
      if (const int hold = system.hold_of[row]; hold >= 0)
        x.segment<3>(first) = (system.holds[at(hold)].allowed * x.segment<3>(first)).eval();
    });
  };
  MassProduct product(mass);
  core::Random random(1, 0);
  VecX current(mass.size()), previous = VecX::Zero(mass.size()), next(mass.size());
  for (Eigen::Index i = 0; i < current.size(); ++i) current(i) = random.uniform(-1.0, 1.0);
  restrict_and_divide(current, false);
  rigid.remove_motion(current);
  const double start = product(current, current);
  if (!(start > 0.0)) return 0.0;
  current /= core::sqrt(start);

  std::vector<double> diagonal, beside;
  double least = 0.0;
  int quiet = 0;
  for (int step = 1; step <= kMostSteps; ++step) {
    core::parallel_chunks(rows, kRowGrain, [&](Size begin, Size end) {
      multiply_rows<1>(*system.rows, system.rows->entries.data(), begin, end, current.data(), next.data());
    });
    restrict_and_divide(next, true);
    const double along = product(next, current);
    diagonal.push_back(along);
    next -= along * current;
    if (!beside.empty()) next -= beside.back() * previous;
    if (step % kRelieveEvery < 2) rigid.remove_motion(next);
    const double left = core::sqrt(product(next, next));
    const bool is_exhausted = !(left > 1e-12 * along);
    if (step % kCheckEvery == 0 || is_exhausted) {
      const double found = least_eigenvalue(diagonal, beside);
      quiet = std::abs(least - found) <= kLeastChange * found ? quiet + 1 : 0;
      least = found;
      if (is_exhausted || quiet >= kQuietChecks) break;
    }
    beside.push_back(left);
    previous.swap(current);
    current = next / left;
  }
  return least;
}

}  // namespace shatterbox::stress
