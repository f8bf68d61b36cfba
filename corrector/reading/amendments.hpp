#pragma once
/// @file
/// Later changes to the occupations of a day by a person, in a separate file.  The record and the
/// event log are not changed.
///
/// Mistakes of the field are put right this way: a slip in a name, a start that was pressed too
/// early, or a knock that nobody marked.  Each has a reason, which the results show.  Example of a
/// file:
///
///     [[exclude]]
///     site = "No.2"
///     occupation = 1
///     set_up = 2                             # without it: the whole stay
///     reason = "knocked over"
///     [[retime]]
///     site = "No.5"
///     occupation = 1
///     start_utc = "2017-07-16T05:01:00Z"     # without a zone: UTC
///     reason = "started before the tripod was levelled"
///     [[step]]                               # readings after it have an unknown offset
///     time_utc = "2017-07-16T06:00:00Z"
///     reason = "box hit the tailboard"
///     [[reference]]
///     site = "No.6"
///     use = false                            # or gravity_mgal = 979951.2
///     reason = "benchmark was rebuilt"
///
/// Order of use: read the list, call amend(), then drop_invalid_occupations().  The last one
/// removes what an amendment made impossible, such as overlaps.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/occupation_list.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::corrector::reading {

/// An amendment that was carried out.
struct Amendment {
    std::string kind = {};  ///< exclude, include, retime, rename, set_up, step, reference.
    std::string site = {};  ///< Site before all amendments, as `occupation`; empty: a step.
    std::optional<int> occupation =
        {};                          ///< Number of the stay at this site, from 1; absent: no stay.
    std::optional<int> set_up = {};  ///< Number of the set-up within the stay, from 1; absent: all.
    std::string change = {};         ///< Change in words; empty if the kind says everything.
    std::string reason = {};         ///< Reason as written in the file; not empty.
};

/// Amendments that were carried out, and those of the day that concern no stay.
struct Amendments {
    std::vector<Amendment> list;                  ///< In the order of amend(), then of the file.
    std::vector<UtcTime> steps;                   ///< Steps of the readings, ascending.
    std::vector<std::string> refused_references;  ///< Sites whose reference no fit may use.
};

/// Carries out the amendments of a TOML file.
///
/// The file has arrays of tables: [[exclude]] (out of every fit), [[include]] (used 1), [[retime]]
/// (start_utc, end_utc or both), [[rename]] (to) and [[set_up]] (time_utc).  Each has site,
/// occupation, set_up (not in rename and set_up) and reason.
///
/// [[set_up]] divides a set-up where the box was lifted.  [[step]] has time_utc and reason,
/// [[reference]] has site, reason, and `use = false` or gravity_mgal.
///
/// All amendments name the occupations as they were in the list before.  A renamed stay keeps its
/// number if the other site has no stay of this number; otherwise it gets the next one.  Every
/// changed window gets a note.
///
/// The notes are excluded, included, retimed, renamed and divided.  One window may be changed once in its
/// use, once in its times and once in its name; more is a contradiction.  Hence `include` cannot
/// undo an `exclude` of the same file.  A retime of a stay with several set-ups must name one.
///
/// The order of the windows is not changed, also if the times are; the parts of a divided one follow
/// each other.  If an exception is thrown,
/// `windows` may be amended in part; read the list again.
///
/// @param windows  all occupations of the survey; set-ups of a stay are numbered in this order.
/// @param file  TOML file.  An empty file is permitted and changes nothing.
/// @param sites  table of the sites; a new name must be in it, and the site of a reference.  Its
///               references are changed.
/// @return the amendments, in the order of kinds above.
/// @throws InputError  unknown key, no reason, no such occupation or site, contradiction, an instant
///                     that is not within the stay; or the
///                     file cannot be read.  The message has line, key, value and what is allowed.
Amendments amend(std::vector<OccupationWindow>& windows, const std::filesystem::path& file,
                 std::vector<text::Site>& sites);

/// Refuses the value of a key that is not the name of a site; the message has all names.
/// @throws InputError  `name` is not in the table of sites.
void require_site(const text::TomlTable& table, std::string_view key,
                  const std::vector<text::Site>& sites, const std::string& name);

/// Returns one line per amendment, each with a line end, for the printed report:
///
///     amended: exclude No.2 (1), set-up 2: knocked over
[[nodiscard]] std::string amendments_text(const std::vector<Amendment>& amendments);

/// Returns an array with one object per amendment, for result.json.  The keys are kind, site,
/// occupation, set_up, change and reason; what does not apply is null.
[[nodiscard]] nlohmann::ordered_json amendments_json(const std::vector<Amendment>& amendments);

}  // namespace a351::corrector::reading
