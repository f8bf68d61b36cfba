#pragma once
/// @file
/// The columns of one line of a gravimeter, with the first trouble that was found in them.
///
///     Fields fields(split_at_blanks(line), kColumns);
///     reading.value = MilliGal(fields.number("GRAV.", -20e3, 20e3));
///     if (!fields.trouble().empty()) return Refusal{fields.trouble()};

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::corrector::gravimeter {

/// Limits of a reading and of a tide correction, mGal.  Reason: the range of a gravimeter for the
/// whole Earth is 8000 mGal, and no solid-Earth tide exceeds 0.3 mGal.
inline constexpr double kGreatestReading_mgal = 20e3, kGreatestTide_mgal = 1.0;

/// Returns the parts of a line between blanks and tabs; none is empty.
[[nodiscard]] std::vector<std::string_view> split_at_blanks(std::string_view line);
/// Returns the parts of a line between separators, without surrounding blanks; they can be empty.
[[nodiscard]] std::vector<std::string_view> split_at(std::string_view line, char separator);
/// Returns the text without blanks and tabs at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The cells of a line, found by the name of their column.
///
/// The views must outlive the object.  After a trouble the values are 0 and must not be used.
class Fields {
public:
    Fields(std::vector<std::string_view> cells, const std::vector<std::string_view>& names);

    /// Returns the first trouble in a few words; empty if there is none.
    [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
    /// Returns a cell; empty if there is no such column, which is a trouble.
    [[nodiscard]] std::string_view text(std::string_view name);
    /// Returns a number within limits.
    [[nodiscard]] double number(std::string_view name, double low, double high);
    /// Returns the name of a station, which must be one of a table of sites.
    [[nodiscard]] std::string site(std::string_view name);
    /// Returns an instant from a date YYYY/MM/DD or YYYY-MM-DD and a time hh:mm:ss.
    /// @param utc_minus_local  to be added to the time of the file.
    [[nodiscard]] UtcTime time(std::string_view date, std::string_view time,
                               std::chrono::minutes utc_minus_local = {});
    /// Returns true if a cell has something other than dashes.
    [[nodiscard]] bool is_given(std::string_view name);

private:
    void refuse(std::string_view name, std::string_view cell, std::string_view reason);

    std::vector<std::string_view> cells_;
    const std::vector<std::string_view>& names_;
    std::string trouble_;
};

}  // namespace a351::corrector::gravimeter
