#pragma once
/// @file
/// Compares the sites of a list with each other and with the normal Earth.
///
///     if (const Message doubt = doubtful_site(read_sites("sites.csv")); !doubt.empty()) warn(doubt);

#include <string_view>
#include <vector>

#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::text {

/// Returns true if two different names can be one in two writings: they differ only in capitals,
/// blanks, zeros before a number or zeros after its point.  no.1 is like No.01, and 16 like 0016 and
/// 16.000, but 1.1 is not like 1.10 or 1.01.
[[nodiscard]] bool differ_in_writing(std::string_view one, std::string_view other);

/// Returns a sentence about the site of a list that fits least, with what to check; empty if all fit.
///
/// A list can be right and have such a site, a summit for example, so this is no error.  The first
/// of these that any site of the list meets is said, about the site that meets it most:
///
/// 1. It is more than 100 km from the nearest other site.
/// 2. Its altitude is more than 1500 m from the median of those of the sites within 100 km, if there
///    are two or more.
/// 3. Its reference is more than 300 mGal from normal gravity at its latitude and altitude.
/// 4. Its name differs from another one only in writing, as differ_in_writing().
///
/// Reason for the limits: 418 sites in the plains and mountains of North China (tests/golden/igp) are
/// at most 61 km from the nearest other one and 871 m from the median, so none of them is doubtful
/// (igp_network_test.cpp).  300 mGal are the attraction of 2.7 km of rock (bouguer_plate()): only the
/// relief of a high summit makes such a free-air anomaly, and a wrong unit or sign exceeds it.
/// Sites without a position are not compared, and those without an altitude not in 2 and 3.
/// @param station  the recorder's own position, named after 1 if it is farther from all sites; null:
///                 none.
[[nodiscard]] Message doubtful_site(const std::vector<Site>& sites, const Site* station = nullptr);

}  // namespace a351::text
