#include "corrector/judgement/reading_name.hpp"

#include <fmt/core.h>

namespace a351::corrector::judgement {

std::string reading_name(const std::vector<model::CorrectedRow>& rows, std::size_t index) {
    const reading::SurveyRow& row = rows[index].row;
    std::size_t before = 0;
    std::size_t in_all = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!reading::is_same_stay(rows[i].row, row)) continue;
        ++in_all;
        if (i < index) ++before;
    }
    constexpr std::size_t kLetters = 26;
    std::string set_up;
    if (in_all > 1) {
        set_up = before < kLetters ? std::string(1, static_cast<char>('a' + before))
                                   : '-' + std::to_string(before + 1);
    }
    return fmt::format("{} ({}{})", row.site, row.occupation, set_up);
}

std::string stay_name(const reading::SurveyRow& row) {
    return row.instrument.empty()
               ? reading::stay_name(row.site, row.occupation)
               : fmt::format("{} ({}, {})", row.site, row.occupation, row.instrument);
}

}  // namespace a351::corrector::judgement
