#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hsgm::geometry {

/// Functions of (row, col) known at the nodes of a regular lattice, and in between by cubic
/// polynomials through the four nearest nodes each way (exact for cubics). The nodes reach
/// one step or more beyond the rectangle in which it is asked, so nothing is extrapolated.
/// Immutable once filled; a value depends on nothing but its place.
class Lattice {
public:
    Lattice() = default;
    /// Node (i, j) lies at row `first_row + i * step`, col `first_col + j * step`; each holds
    /// `channels` numbers. At least 4 x 4 nodes.
    Lattice(double first_row, double first_col, double step, int rows, int cols, int channels);

    double first_row() const { return first_row_; }
    double first_col() const { return first_col_; }
    double step() const { return step_; }
    int rows() const { return rows_; }
    int cols() const { return cols_; }
    int channels() const { return channels_; }

    std::span<double> node(int i, int j);
    std::span<const double> node(int i, int j) const;
    const std::vector<double>& values() const { return values_; }
    std::vector<double>& values() { return values_; }

    /// All channels at a place.
    void at(double row, double col, std::span<double> result) const;

    /// The same lattice with places counted from (row, col) on.
    void move_origin(double row, double col);

    bool operator==(const Lattice&) const = default;

private:
    friend class LatticeRow;
    double first_row_ = 0;
    double first_col_ = 0;
    double step_ = 1;
    int rows_ = 0;
    int cols_ = 0;
    int channels_ = 0;
    std::vector<double> values_;
};

/// A lattice along one row: the sums over rows are done once, so each place costs four nodes.
/// Gives the same bits as `Lattice::at`. Make one and `set` it again and again.
class LatticeRow {
public:
    explicit LatticeRow(const Lattice& lattice);
    void set(double row);
    void at(double col, std::span<double> result) const;

private:
    const Lattice& lattice_;
    std::vector<double> values_; // channels of every column of nodes
};

} // namespace hsgm::geometry
