#pragma once
/// @file
/// Later changes to the occupations of a day by a person, in a separate file.  The record and the
/// event log are not changed.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/occupation_list.hpp"

namespace a351::corrector {

/// An amendment that was carried out.
struct Amendment {
    std::string kind;  ///< exclude, include, retime, rename.
    std::string site;  ///< Site before all amendments, as `occupation` and `set_up`.
    int occupation = 1;
    std::optional<int> set_up;  ///< Number of the set-up within the stay, from 1; absent: all.
    std::string change;         ///< Change in words; empty if the kind says everything.
    std::string reason;
};

/// Carries out the amendments of a TOML file.
///
/// The file has arrays of tables: [[exclude]] (out of every fit), [[include]] (used 1), [[retime]]
/// (start_utc, end_utc or both) and [[rename]] (to).  Each has site, occupation, set_up (not in
/// rename) and reason.
///
/// All amendments name the occupations as they were in the list before.  A renamed stay keeps its
/// number if the other site has no stay of this number; otherwise it gets the next one.  Every
/// changed window gets a note.
/// @return the amendments, in the order of kinds above, then of the file.
/// @throws InputError  unknown key, no reason, no such occupation or site, contradiction.
std::vector<Amendment> amend(std::vector<OccupationWindow>& windows,
                             const std::filesystem::path& file,
                             const std::vector<text::Site>& sites);

/// Returns one line per amendment.
[[nodiscard]] std::string amendments_text(const std::vector<Amendment>& amendments);

/// Returns an array with one object per amendment.
[[nodiscard]] nlohmann::ordered_json amendments_json(const std::vector<Amendment>& amendments);

}  // namespace a351::corrector
