#include "pipeline/geometry/lattice.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace hsgm::geometry {

namespace {

/// Four nodes in a row and the weights of Lagrange's cubic through them.
struct Stencil {
    int first = 0;
    std::array<double, 4> weight{};
};

Stencil stencil(double position, int nodes)
{
    const int cell = std::clamp(static_cast<int>(std::floor(position)), 1, nodes - 3);
    const double t = position - cell; // between nodes cell (0) and cell + 1 (1)
    return {cell - 1,
            {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
             -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6}};
}

double weighted(const std::array<double, 4>& w, double a, double b, double c, double d)
{
    return (w[0] * a + w[1] * b) + (w[2] * c + w[3] * d);
}

} // namespace

Lattice::Lattice(double first_row, double first_col, double step, int rows, int cols,
                 int channels)
    : first_row_(first_row), first_col_(first_col), step_(step), rows_(rows), cols_(cols),
      channels_(channels),
      values_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) *
              static_cast<std::size_t>(channels))
{
    assert(rows >= 4 && cols >= 4 && channels >= 1 && step > 0);
}

std::span<double> Lattice::node(int i, int j)
{
    assert(i >= 0 && i < rows_ && j >= 0 && j < cols_);
    const auto n = static_cast<std::size_t>(channels_);
    return {values_.data() + (std::size_t(i) * std::size_t(cols_) + std::size_t(j)) * n, n};
}

std::span<const double> Lattice::node(int i, int j) const
{
    assert(i >= 0 && i < rows_ && j >= 0 && j < cols_);
    const auto n = static_cast<std::size_t>(channels_);
    return {values_.data() + (std::size_t(i) * std::size_t(cols_) + std::size_t(j)) * n, n};
}

void Lattice::at(double row, double col, std::span<double> result) const
{
    const Stencil down = stencil((row - first_row_) / step_, rows_);
    const Stencil across = stencil((col - first_col_) / step_, cols_);
    for (int k = 0; k < channels_; ++k) {
        std::array<double, 4> column{};
        for (int j = 0; j < 4; ++j) {
            const auto value = [&](int i) {
                return node(down.first + i, across.first + j)[static_cast<std::size_t>(k)];
            };
            column[static_cast<std::size_t>(j)] =
                weighted(down.weight, value(0), value(1), value(2), value(3));
        }
        result[static_cast<std::size_t>(k)] =
            weighted(across.weight, column[0], column[1], column[2], column[3]);
    }
}

void Lattice::move_origin(double row, double col)
{
    first_row_ -= row;
    first_col_ -= col;
}

LatticeRow::LatticeRow(const Lattice& lattice)
    : lattice_(lattice), values_(static_cast<std::size_t>(lattice.cols()) *
                                 static_cast<std::size_t>(lattice.channels()))
{
}

void LatticeRow::set(double row)
{
    const Stencil down = stencil((row - lattice_.first_row_) / lattice_.step_, lattice_.rows_);
    const std::size_t n = values_.size();
    const double* nodes = lattice_.values_.data() + static_cast<std::size_t>(down.first) * n;
    for (std::size_t k = 0; k < n; ++k) {
        values_[k] =
            weighted(down.weight, nodes[k], nodes[n + k], nodes[2 * n + k], nodes[3 * n + k]);
    }
}

void LatticeRow::at(double col, std::span<double> result) const
{
    const Stencil across =
        stencil((col - lattice_.first_col_) / lattice_.step_, lattice_.cols_);
    const auto channels = static_cast<std::size_t>(lattice_.channels_);
    const double* column = values_.data() + static_cast<std::size_t>(across.first) * channels;
    for (std::size_t k = 0; k < channels; ++k) {
        result[k] = weighted(across.weight, column[k], column[channels + k],
                             column[2 * channels + k], column[3 * channels + k]);
    }
}

} // namespace hsgm::geometry
