#pragma once
/// @file
/// The rows and the refusals of all series of set-ups at one point.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/occupation_rows.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector::series {

/// Returns true for a set-up that is used.
[[nodiscard]] inline bool is_in_series(const reading::SurveyRow& row) {
    return !row.is_flagged && !row.is_excluded;
}

/// A series that is checked.  Its refusals name it and the file or folder that it comes from.
struct CheckedSeries {
    std::string_view name;
    const std::string& origin;
    const reading::OccupationRows& read;

    /// @throws InputError  always.
    [[noreturn]] void refuse(const std::string& trouble, const std::string& allowed) const;
    /// @throws InputError  set-ups at several sites.
    void require_one_point() const;
    /// @throws InputError  the whole-day model refuses the record.
    void require_day() const;

    /// Returns the number of set-ups that are used.
    [[nodiscard]] std::size_t set_ups() const;
    /// Returns the reference of the point; without one standard gravity, which is wrong by at most 3 Gal.
    [[nodiscard]] MilliGal gravity() const;
    /// Returns one station for the used set-ups, with this gravity, and one for each other.
    [[nodiscard]] std::vector<whole_day::DayStation> stations() const;
};

}  // namespace a351::corrector::series
