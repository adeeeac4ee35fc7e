#pragma once

#include <cstddef>

namespace carom::detail {

/// What `Columns` is asked, four vectors at a time: blocks of the x of four, their y and their z. Nothing but
/// plain loops, since they are compiled for other instructions than the rest.
struct ColumnsKernel {
    std::size_t (*furthest)(const double* blocks, std::size_t count, const double* direction);
    void (*products)(const double* blocks, std::size_t count, const double* v, double* result);
    void (*range)(const double* blocks, std::size_t count, const double* direction, double* result);
};

/// For processors that take four doubles at once.
extern const ColumnsKernel columns_kernel_8;

}  // namespace carom::detail
