// SPDX-License-Identifier: MIT
// Algorithm 1 of Peters and Klein 2015: of all distributions on finitely many depths that have given means of given
// functions, one that puts the least mass in front of a fragment, by linear programming. For testing what is quicker.
#pragma once

#include <glpk.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace penumbra::test {

// What a depth adds to the rows, of which the first is the mass itself, and to what is minimised.
struct Column {
    static constexpr size_t mostRows = 8;
    std::array<double, mostRows> rows{};
    bool inFront = false;
};

class Algorithm1 {
public:
    // `means` of the functions, the mass 1 among them.
    explicit Algorithm1(std::vector<double> means) : means_(std::move(means)), problem_(glp_create_prob()) {
        glp_set_obj_dir(problem_, GLP_MIN);
        glp_add_rows(problem_, count());
        for (int row = 0; row < count(); ++row) {
            const double mean = means_[static_cast<size_t>(row)];
            glp_set_row_bnds(problem_, row + 1, GLP_FX, mean, mean);
        }
    }
    ~Algorithm1() { glp_delete_prob(problem_); }
    Algorithm1(const Algorithm1&) = delete;
    Algorithm1& operator=(const Algorithm1&) = delete;

    // Columns are scaled, since powers of far depths make a solver fail.
    void add(const Column& column) {
        columns_.push_back(column);
        double largest = 0;
        for (int row = 0; row < count(); ++row)
            largest = std::max(largest, std::abs(column.rows[static_cast<size_t>(row)]));
        const int place = glp_add_cols(problem_, 1);
        int rows[Column::mostRows + 1];
        double values[Column::mostRows + 1];
        for (int row = 0; row < count(); ++row) {
            rows[row + 1] = row + 1;
            values[row + 1] = column.rows[static_cast<size_t>(row)] / largest;
        }
        glp_set_mat_col(problem_, place, count(), rows, values);
        glp_set_col_bnds(problem_, place, GLP_LO, 0, 0);
        glp_set_obj_coef(problem_, place, column.inFront ? 1 / largest : 0);
    }

    // The least mass in front; NaN where the solver fails. Which depths are needed is the solver's answer; their
    // weights are worked out again with more digits than it has.
    double solve() {
        glp_smcp options;
        glp_init_smcp(&options);
        options.msg_lev = GLP_MSG_OFF;
        options.tol_bnd = options.tol_dj = 1e-11;
        options.tm_lim = 1000;
        if (glp_simplex(problem_, &options) != 0 || glp_get_status(problem_) != GLP_OPT) return NAN;
        std::vector<const Column*> atoms;
        for (size_t j = 0; j < columns_.size(); ++j)
            if (glp_get_col_stat(problem_, static_cast<int>(j) + 1) == GLP_BS) atoms.push_back(&columns_[j]);
        const std::vector<long double> weights = weightsOf(atoms);
        long double least = 0;
        for (size_t j = 0; j < atoms.size(); ++j) {
            if (!(weights[j] > -1e-6L)) return NAN; // the solver's tolerance let a wrong set of atoms pass
            least += atoms[j]->inFront ? weights[j] : 0;
        }
        return static_cast<double>(least);
    }

    // By how much a mass on a further depth would change the least mass, per mass: what is below 0 is worth adding.
    double reducedCost(const Column& column) const {
        double cost = column.inFront ? 1 : 0;
        for (int row = 0; row < count(); ++row)
            cost -= glp_get_row_dual(problem_, row + 1) * column.rows[static_cast<size_t>(row)];
        return cost;
    }

private:
    int count() const { return static_cast<int>(means_.size()); }

    // By elimination; as many atoms as there are rows, or fewer.
    std::vector<long double> weightsOf(const std::vector<const Column*>& atoms) const {
        const size_t n = atoms.size(), equations = means_.size();
        std::vector<std::vector<long double>> rows(equations, std::vector<long double>(n + 1));
        for (size_t k = 0; k < equations; ++k) {
            for (size_t j = 0; j < n; ++j) rows[k][j] = atoms[j]->rows[k];
            rows[k][n] = means_[k];
        }
        for (size_t j = 0; j < n; ++j) {
            const auto larger = [&](const auto& p, const auto& q) { return std::abs(p[j]) < std::abs(q[j]); };
            std::swap(rows[j], *std::max_element(rows.begin() + static_cast<std::ptrdiff_t>(j), rows.end(), larger));
            for (size_t k = 0; k < equations; ++k) {
                if (k == j) continue;
                const long double factor = rows[k][j] / rows[j][j];
                for (size_t i = j; i <= n; ++i) rows[k][i] -= factor * rows[j][i];
            }
        }
        std::vector<long double> weights;
        for (size_t j = 0; j < n; ++j) weights.push_back(rows[j][n] / rows[j][j]);
        return weights;
    }

    std::vector<double> means_;
    std::vector<Column> columns_;
    glp_prob* problem_;
};

// A depth in [0, 1] and the share of a kernel that lies there.
struct Atom {
    double z, weight;
};

// Relative to its largest, the mean square below which a function counts as 0 on a kernel.
template <class Real> inline constexpr Real leastSquare = 1e-22L;

// The sharp lower bound of the share of depths in front of z_f for any functions on [0, 1], whose means over `atoms`
// are all that is known of them. Functions are made orthonormal over the atoms, so that the means are 1, 0, 0 ...;
// depths begin with the atoms themselves, which have these means, and a coarse grid, and those that lower the mass are
// added. Over atoms of a width w smooth functions differ by wᵏ: a Real of more digits knows narrower kernels.
template <class Real = long double, class Function> // Real → Real
double sharpBound(const std::vector<Function>& functions, const std::vector<Atom>& atoms, double z_f) {
    using Row = std::array<Real, Column::mostRows>;
    const size_t count = functions.size() + 1;
    const auto raw = [&](double z) {
        Row row{1};
        for (size_t k = 1; k < count; ++k) row[k] = functions[k - 1](z);
        return row;
    };
    std::vector<Row> combined(count, Row{}); // of the functions
    const auto at = [&](const Row& values, size_t k) {
        Real sum = 0;
        for (size_t j = 0; j <= k; ++j) sum += combined[k][j] * values[j];
        return sum;
    };
    std::vector<Row> onAtoms;
    for (const Atom& atom : atoms) onAtoms.push_back(raw(atom.z));
    combined[0][0] = 1;
    for (size_t k = 1; k < count; ++k) {
        combined[k][k] = 1;
        const auto mean = [&](auto&& f) {
            Real sum = 0;
            for (size_t i = 0; i < atoms.size(); ++i) sum += atoms[i].weight * f(onAtoms[i]);
            return sum;
        };
        for (int twice = 0; twice < 2; ++twice)
            for (size_t j = 0; j < k; ++j) {
                const Real along = mean([&](const Row& v) { return at(v, k) * at(v, j); });
                const Real square = mean([&](const Row& v) { return at(v, j) * at(v, j); });
                if (square > 0.5L)
                    for (size_t i = 0; i <= j; ++i) combined[k][i] -= along * combined[j][i];
            }
        // One that is 0 on all atoms must be 0 wherever there is mass, and may have any size.
        const Real square = mean([&](const Row& v) { return at(v, k) * at(v, k); });
        Real largest = 0;
        for (int i = 0; i <= 16; ++i) {
            const Real value = at(raw(i / 16.0), k);
            largest = std::max(largest, value < 0 ? -value : value);
        }
        const bool vanishes = square <= leastSquare<Real> * largest * largest;
        const Real scale = 1 / (vanishes ? largest : Real(std::sqrt(static_cast<long double>(square))));
        for (size_t i = 0; i <= k; ++i) combined[k][i] *= scale;
    }
    const auto column = [&](double z) {
        Column c;
        const Row values = raw(z);
        for (size_t k = 0; k < count; ++k) c.rows[k] = static_cast<double>(at(values, k));
        c.inFront = z < z_f;
        return c;
    };
    std::vector<double> means(count, 0.0);
    means[0] = 1;
    Algorithm1 problem(std::move(means));
    double mean = 0, square = 0;
    for (const Atom& atom : atoms) {
        problem.add(column(atom.z));
        mean += atom.weight * atom.z, square += atom.weight * atom.z * atom.z;
    }
    problem.add(column(z_f));
    // Where further depths are looked for: all over the range, denser around the kernel's and the fragment's.
    std::vector<double> places{std::nextafter(z_f, 0.0)};
    const double sigma = std::max(std::sqrt(std::max(square - mean * mean, 0.0)), 1e-4);
    for (int i = 0; i <= 128; ++i) places.push_back(i / 128.0);
    for (int i = -48; i <= 48; ++i) {
        const double away = i / 12.0;
        for (const double z : {mean + sigma * away, z_f + 0.1 * sigma * away})
            if (z > 0 && z < 1) places.push_back(z);
    }
    std::sort(places.begin(), places.end());
    std::vector<Column> looked;
    for (const double z : places) looked.push_back(column(z));
    for (size_t i = 0; i < looked.size(); i += 8) problem.add(looked[i]);

    double least = NAN;
    for (int round = 0; round < 30; ++round) {
        const double now = problem.solve();
        if (!std::isfinite(now)) return least;
        least = now;
        std::vector<double> costs;
        for (const Column& c : looked) costs.push_back(problem.reducedCost(c));
        bool added = false;
        for (size_t i = 0; i < costs.size(); ++i) {
            const bool lowest =
                (i == 0 || costs[i] <= costs[i - 1]) && (i + 1 == costs.size() || costs[i] <= costs[i + 1]);
            if (!lowest) continue;
            // The minimum beside it, on its side of the fragment.
            double low = places[i > 0 ? i - 1 : 0], high = places[std::min(i + 1, places.size() - 1)];
            if (places[i] < z_f) high = std::min(high, std::nextafter(z_f, 0.0));
            if (places[i] >= z_f) low = std::max(low, z_f);
            const auto costAt = [&](double z) { return problem.reducedCost(column(z)); };
            constexpr double golden = 0.381966011;
            double a = low + golden * (high - low), b = high - golden * (high - low), costA = costAt(a),
                   costB = costAt(b);
            for (int step = 0; step < 20; ++step) {
                if (costA < costB) {
                    high = b, b = a, costB = costA;
                    a = low + golden * (high - low), costA = costAt(a);
                } else {
                    low = a, a = b, costA = costB;
                    b = high - golden * (high - low), costB = costAt(b);
                }
            }
            const Column best = column(0.5 * (low + high));
            if (problem.reducedCost(best) > -1e-7) continue;
            problem.add(best);
            added = true;
        }
        if (!added) return least;
    }
    return least;
}

} // namespace penumbra::test
