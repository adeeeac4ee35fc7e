#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/reflect.hpp"

namespace carom::detail {

namespace {

/// Solves A x = −b for the chosen rows and columns alone, by Cholesky's decomposition.
class ChosenRows {
  public:
    ChosenRows(std::span<const double> matrix, std::span<const double> b, double more)
        : matrix_(matrix), b_(b), more_(more) {}

    void solve(const std::vector<std::size_t>& chosen, std::span<double> x) {
        const std::size_t n = chosen.size(), rows = b_.size();
        lower_.resize(n * n);
        right_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double* row = &matrix_[chosen[i] * rows];
            double* l = &lower_[i * n];
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = row[chosen[j]] + (i == j ? more_ : 0);
                for (std::size_t k = 0; k < j; ++k) sum -= l[k] * lower_[j * n + k];
                l[j] = i == j ? std::sqrt(std::max(sum, more_)) : sum / lower_[j * n + j];
            }
            double sum = -b_[chosen[i]];
            for (std::size_t k = 0; k < i; ++k) sum -= l[k] * right_[k];
            right_[i] = sum / l[i];
        }
        std::ranges::fill(x, 0.0);
        for (std::size_t i = n; i-- > 0;) {
            double sum = right_[i];
            for (std::size_t k = i + 1; k < n; ++k) sum -= lower_[k * n + i] * right_[k];
            right_[i] = sum / lower_[i * n + i];
            x[chosen[i]] = right_[i];
        }
    }

  private:
    std::span<const double> matrix_, b_;
    double more_;
    std::vector<double> lower_, right_;
};

}  // namespace

/// Block principal pivoting: all rows on the wrong side change it at once, and as long as this does not get
/// on, only the last of them (J. Júdice, F. Pires 1994), which always ends. A little is added to the
/// diagonal.
void solve_complementarity(std::span<const double> matrix, std::span<const double> b, std::span<double> x) {
    const std::size_t n = b.size();
    double largest = 0, fastest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        largest = std::max(largest, matrix[i * n + i]);
        fastest = std::max(fastest, std::fabs(b[i]));
    }
    if (largest == 0) {
        std::ranges::fill(x, 0.0);
        return;
    }
    if (n == 1) {
        x[0] = std::max(0.0, -b[0] / matrix[0]);
        return;
    }
    const double speed_noise = 1e-12 * fastest, push_noise = speed_noise / largest;
    ChosenRows system(matrix, b, 1e-11 * largest);

    std::vector<std::uint8_t> pushes(n);
    std::vector<std::size_t> chosen, wrong;
    for (std::size_t i = 0; i < n; ++i) pushes[i] = b[i] < 0;
    std::size_t fewest = n + 1;
    int patience = 3;
    for (std::size_t turn = 0; turn < 10 * n + 50; ++turn) {
        chosen.clear();
        for (std::size_t i = 0; i < n; ++i)
            if (pushes[i]) chosen.push_back(i);
        system.solve(chosen, x);
        wrong.clear();
        for (std::size_t i = 0; i < n; ++i) {
            if (pushes[i]) {
                if (x[i] < -push_noise) wrong.push_back(i);
                continue;
            }
            const double* row = &matrix[i * n];
            if (std::inner_product(row, row + n, x.begin(), b[i]) < -speed_noise) wrong.push_back(i);
        }
        if (wrong.empty()) break;
        if (wrong.size() < fewest) {
            fewest = wrong.size();
            patience = 3;
        } else if (--patience < 0) {
            wrong.erase(wrong.begin(), wrong.end() - 1);
        }
        for (const std::size_t i : wrong) pushes[i] ^= 1;
    }
    for (double& value : x) value = std::max(value, 0.0);
}

}  // namespace carom::detail
