#include "corrector/whole_day/day_adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

ErrorSource source_of(const adjustment::Term& term) {
    if (&term == &adjustment::kConstant) return ErrorSource::datum;
    switch (term.correction) {
        case adjustment::Correction::drift:
            return ErrorSource::drift;
        case adjustment::Correction::tilt:
            return ErrorSource::levelling;
        case adjustment::Correction::scale:
            return ErrorSource::scale;
        default:
            return ErrorSource::thermal;
    }
}

/// Returns the sources of the priors of a survey's columns, in the order of DayProblem::whitened()
/// without the readings.
std::vector<ErrorSource> sources_of(const DayRegression& survey, std::size_t set_ups_of_box) {
    std::vector<ErrorSource> sources;
    for (const adjustment::Term* const term : kDayTermList) sources.push_back(source_of(*term));
    sources.resize(static_cast<std::size_t>(survey.states_begin()), ErrorSource::datum);
    sources.resize(static_cast<std::size_t>(survey.on_scale_begin()), ErrorSource::thermal);
    if (survey.on_scale() > 0)
        for (const DayTerm term : DayRegression::kOnScale)
            sources.push_back(source_of(*kDayTermList.at(static_cast<std::size_t>(term))));
    sources.resize(sources.size() + set_ups_of_box, ErrorSource::placement);
    sources.resize(sources.size() + kDayLags, ErrorSource::thermal);
    sources.resize(sources.size() + survey.base_mgal().size(), ErrorSource::datum);
    return sources;
}

/// Returns the matrix (bins, set-ups) with 1 for the bins of each set-up.
Eigen::MatrixXd set_ups_of_bins(const std::vector<reading::DayBin>& bins) {
    Eigen::MatrixXd members =
        Eigen::MatrixXd::Zero(std::ssize(bins), static_cast<Index>(bins.back().set_up) + 1);
    for (std::size_t i = 0; i < bins.size(); ++i)
        members(static_cast<Index>(i), static_cast<Index>(bins[i].set_up)) = 1.0;
    return members;
}

}  // namespace

DayAdjustment::DayAdjustment(std::shared_ptr<const DayProblem> problem, DaySearch found)
    : problem_(std::move(problem)), found_(std::move(found)) {
    set_columns();
    set_gravities();
}

void DayAdjustment::set_columns() {
    const DayProblem& problem = *problem_;
    std::vector<Eigen::MatrixXd> most_likely, expected;  // both points have the same lags
    for (std::size_t k = 0; k < problem.surveys().size(); ++k) {
        for (const bool is_expected : {false, true}) {
            const DayPoint& point = is_expected ? found_.expected : found_.most_likely;
            (is_expected ? expected : most_likely)
                .push_back(problem.of(k).scaled(problem.part_of(point, k)));
        }
    }
    const DayProblem::Solution solution = problem.solve(found_.most_likely, most_likely),
                               at_expected = problem.solve(found_.expected, expected);
    common_ = solution.common;
    std::vector<DayProblem::Normal> normals;
    for (std::size_t k = 0; k < problem.surveys().size(); ++k) {
        const DayRegression& regression = problem.of(k);
        SurveyPart& part = surveys_.emplace_back();
        part.scaled = solution.surveys[k];
        part.values = regression.unscaled(problem.part_of(found_.most_likely, k),
                                          part.scaled.head(regression.estimated()));
        part.placement_mgal = placement_mgal(k, most_likely[k]);
        DayProblem::Normal& normal = normals.emplace_back();
        part.columns =
            problem.whitened(found_.expected, k, expected[k], &part.values, normal.log_determinant);
        normal.products = part.columns.transpose() * part.columns;
        part.left =
            part.columns.col(0) -
            part.columns.middleCols(1, at_expected.surveys[k].size()) * at_expected.surveys[k];
    }
    const auto gravities = static_cast<Index>(problem.gravity_count());
    const Index common = problem.common_count() + gravities;
    information_ = Eigen::MatrixXd::Identity(common, common);
    gradient_ = Eigen::VectorXd::Zero(common);
    sources_.resize(static_cast<std::size_t>(common));
    for (std::size_t group = 0; group < problem.groups().size(); ++group) {
        const DayProblem::Normal normal = problem.of_group(normals, group, true);
        if (const Eigen::MatrixXd& white = problem.groups()[group].of_white_surveys;
            white.size() > 0)
            gradient_.tail(gravities) =
                white.col(common).segment(problem.common_count(), gravities) -
                white.block(problem.common_count(), 0, gravities, problem.common_count()) *
                    at_expected.common;
        information_ += problem.reduced(normal, group).products.topLeftCorner(common, common);
        const auto own = static_cast<std::size_t>(problem.groups()[group].own_count);
        const linear_algebra::Cholesky factor(
            with_priors(normal.products, problem.groups()[group].own_count));
        GroupPart& part = groups_.emplace_back();
        part.answer = -factor.solve(normal.products.block(
            0, problem.groups()[group].own_count, problem.groups()[group].own_count, common));
        part.covariance = factor.inverse();
        part.sources.resize(own);
        for (const std::size_t k : problem.groups()[group].surveys) {
            const DayProblem::Group& of = problem.groups()[group];
            const std::vector<ErrorSource> sources =
                sources_of(problem.of(k), of.is_box() ? of.set_up_count : 0);
            const std::vector<Index> places = problem.places_in_group(k, true);
            for (std::size_t i = 0; i < sources.size(); ++i)
                if (const auto place = static_cast<std::size_t>(places[i + 1]); place < own)
                    part.sources[place] = sources[i];
                else
                    sources_[place - own] = sources[i];
        }
    }
    covariance_ = linear_algebra::Cholesky(
                      information_.topLeftCorner(problem.common_count(), problem.common_count()))
                      .inverse();
}

Eigen::VectorXd DayAdjustment::placement_mgal(std::size_t survey,
                                              const Eigen::MatrixXd& scaled) const {
    const std::vector<reading::DayBin>& bins = problem_->surveys()[survey].record->bins;
    double log_determinant = 0.0;
    const Eigen::MatrixXd columns =
        problem_->whitened(found_.most_likely, survey, scaled, nullptr, log_determinant);
    const Eigen::VectorXd left =
        columns.col(0) - columns.rightCols(columns.cols() - 1) * surveys_[survey].scaled;
    const DayNoise noise = problem_->own_noise(found_.most_likely, survey);
    Eigen::MatrixXd members = set_ups_of_bins(bins);
    problem_->of(survey).whiten(noise, members);
    Eigen::VectorXd placement =
        noise.placement_mgal * noise.placement_mgal * (members.transpose() * left);
    // The columns have the sign of the face, the placement that of the reading.
    const std::vector<double> faces =
        reading::faces_of(bins, static_cast<std::size_t>(placement.size()));
    placement.array() *= Eigen::Map<const Eigen::ArrayXd>(faces.data(), placement.size());
    // In a box, the part that its sensors have in common is a coefficient of each set-up.
    const Eigen::VectorXd& scaled_values = surveys_[survey].scaled;
    for (Index set_up = 0; set_up < placement.size(); ++set_up)
        placement(set_up) += problem_->in_common_mgal(
            found_.most_likely, survey, static_cast<std::size_t>(set_up),
            scaled_values.tail(scaled_values.size() - problem_->of(survey).estimated()));
    return placement;
}

void DayAdjustment::set_gravities() {
    const DayProblem& problem = *problem_;
    gravities_.resize(problem.gravity_count());
    for (const WhiteSurvey& survey : problem.white_surveys())
        for (const DayStation& station : survey.stations) {
            Gravity& gravity = gravities_[station.number];
            gravity.held = gravity.own = problem.place_of(station.number);
            gravity.fitted_mgal = problem.base_mgal(station);
            if (gravity.held >= 0)
                gravity.fitted_mgal += station.deviation_mgal() * common_(gravity.held);
            gravity.hold(station);
        }
    for (std::size_t k = 0; k < surveys_.size(); ++k) {
        const DayRegression& regression = problem.of(k);
        const std::size_t numbers = regression.base_mgal().size();
        const double scale = DayRegression::scale(surveys_[k].values);
        for (std::size_t number = 0; number < numbers; ++number) {
            Gravity& gravity = gravities_[problem.gravity_of(k, number)];
            gravity.held = gravity.own = problem.place_of(problem.gravity_of(k, number));
            gravity.fitted_mgal = regression.base_mgal()[number];
            gravity.scale = scale;
            if (const Index place = regression.place_of(number); place >= 0)
                gravity.fitted_mgal += surveys_[k].values(place) / scale;
        }
        for (const DayStation& station : problem.surveys()[k].stations)
            gravities_[problem.gravity_of(k, station.number)].hold(station);
    }
    for (std::size_t number = 0; number < gravities_.size(); ++number)
        if (gravities_[number].is_held) gravities_[number].own = problem.own_place_of(number);
    // The coefficients are a minimum of these squares, so that only a column that they lack can improve
    // it.  The lags are a minimum of the cost, whose determinants balance theirs: their gradient counts
    // as 0.
    for (std::size_t k = 0; k < surveys_.size(); ++k) {
        const std::size_t numbers = problem.of(k).base_mgal().size();
        const Index first = surveys_[k].columns.cols() - static_cast<Index>(numbers);
        for (std::size_t number = 0; number < numbers; ++number) {
            const Gravity& gravity = gravities_[problem.gravity_of(k, number)];
            if (gravity.is_held)
                gradient_(gravity.own) += surveys_[k]
                                              .columns.col(first + static_cast<Index>(number))
                                              .dot(surveys_[k].left);
        }
    }
}

Eigen::VectorXd DayAdjustment::solved(const std::vector<std::size_t>& hidden,
                                      const Eigen::VectorXd& right) const {
    // A hidden reference that was exact is one more column.  One that was uncertain loses its prior:
    // its column is that of the fit, with the deviation of a free gravity instead of u.
    std::vector<Index> added, freed;
    std::vector<double> shares;  // deviation of the fit's column / that of the own one
    for (const std::size_t number : hidden) {
        const Gravity& gravity = gravities_[number];
        if (gravity.held < 0) {
            added.push_back(gravity.own);
            continue;
        }
        freed.push_back(gravity.held);
        shares.push_back(gravity.u_mgal / kFreeGravity_mgal);
    }
    const Index fitted = covariance_.rows();
    Eigen::VectorXd of_fit = right.head(fitted);
    std::size_t next = 0;
    for (const std::size_t number : hidden)
        if (const Gravity& gravity = gravities_[number]; gravity.held >= 0)
            of_fit(gravity.held) += shares[next++] * right(gravity.own);
    // (N - e a e')^-1 = V + V e (1/a - e'V e)^-1 e' V, with a = 1 - share^2
    Eigen::MatrixXd lost = -covariance_(freed, freed);
    for (std::size_t k = 0; k < freed.size(); ++k)
        lost(static_cast<Index>(k), static_cast<Index>(k)) += 1.0 / (1.0 - shares[k] * shares[k]);
    const Eigen::MatrixXd gain =
        linear_algebra::Cholesky(lost).solve(covariance_(freed, Eigen::all));
    const auto without_priors = [&](const Eigen::MatrixXd& columns) -> Eigen::MatrixXd {
        return covariance_ * columns + covariance_(Eigen::all, freed) * (gain * columns);
    };
    const Eigen::MatrixXd of_added = information_(Eigen::seqN(0, fitted), added);
    const Eigen::MatrixXd answer = without_priors(of_added);
    const Eigen::VectorXd solution = without_priors(of_fit);
    const Eigen::VectorXd of_own =
        linear_algebra::Cholesky(information_(added, added) - of_added.transpose() * answer)
            .solve(right(added) - of_added.transpose() * solution);
    Eigen::VectorXd parts = Eigen::VectorXd::Zero(right.size());
    parts.head(fitted) = solution - answer * of_own;
    parts(added) = of_own;
    next = 0;
    for (const std::size_t number : hidden)
        if (const Gravity& gravity = gravities_[number]; gravity.held >= 0) {
            parts(gravity.own) = shares[next++] * parts(gravity.held);
            parts(gravity.held) = 0.0;
        }
    return parts;
}

MilliGal DayAdjustment::corrected(std::size_t set_up, std::size_t survey) const {
    const std::size_t number = problem_->surveys()[survey].stations[set_up].number;
    return MilliGal(gravities_[problem_->gravity_of(survey, number)].fitted_mgal +
                    surveys_[survey].placement_mgal(static_cast<Index>(set_up)));
}

DayNoise DayAdjustment::noise(std::size_t survey) const {
    return problem_->of(survey).noise(problem_->part_of(found_.most_likely, survey));
}

DayNoise DayAdjustment::expected_noise(std::size_t survey) const {
    return problem_->of(survey).noise(problem_->part_of(found_.expected, survey));
}

std::vector<std::size_t> DayAdjustment::hidden_for(std::size_t number) const {
    // Without its only reference the system has no datum.
    if (gravities_[number].is_held && std::ranges::count(gravities_, true, &Gravity::is_held) > 1)
        return {number};
    return {};
}

Eigen::VectorXd DayAdjustment::wanted(std::size_t number,
                                      const std::vector<std::size_t>& hidden) const {
    const Gravity& gravity = gravities_[number];
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(gradient_.size());
    const bool is_free = !gravity.is_held || std::ranges::find(hidden, number) != hidden.end();
    if (const Index column = is_free ? gravity.own : gravity.held; column >= 0)
        wanted(column) = is_free ? kFreeGravity_mgal : gravity.u_mgal;
    return wanted;
}

double DayAdjustment::error_mgal(const Eigen::VectorXd& parts) const {
    return std::sqrt(parts.dot(information_ * parts));
}

GravityEstimate DayAdjustment::estimate(std::size_t number,
                                        const std::vector<std::size_t>& hidden) const {
    const Eigen::VectorXd parts = solved(hidden, wanted(number, hidden));
    GravityEstimate estimate;
    estimate.value =
        gravities_[number].fitted_mgal + parts.dot(gradient_) / gravities_[number].scale;
    estimate.standard_error = error_mgal(parts);
    set_sources(estimate, parts);
    return estimate;
}

GravityEstimate DayAdjustment::gravity(std::size_t number) const { return estimate(number, {}); }

GravityEstimate DayAdjustment::left_out(std::size_t number) const {
    return estimate(number, hidden_for(number));
}

Estimate DayAdjustment::difference(std::size_t from, std::size_t to) const {
    std::vector<std::size_t> hidden;
    for (const std::size_t number : {from, to})
        if (gravities_[number].is_held) hidden.push_back(number);
    // Without another reference nothing gives the level, on which a difference does not depend.  One
    // of both is then held.
    if (std::ssize(hidden) == std::ranges::count(gravities_, true, &Gravity::is_held))
        hidden.erase(hidden.begin());
    Eigen::VectorXd both = wanted(to, hidden);
    both -= wanted(from, hidden);
    const Eigen::VectorXd parts = solved(hidden, both);
    return {gravities_[to].fitted_mgal - gravities_[from].fitted_mgal +
                parts.dot(gradient_) / gravities_[to].scale,
            error_mgal(parts)};
}

Eigen::MatrixXd DayAdjustment::correlation() const {
    Eigen::MatrixXd parts(gradient_.size(), std::ssize(gravities_));
    for (std::size_t number = 0; number < gravities_.size(); ++number) {
        const std::vector<std::size_t> hidden = hidden_for(number);
        const Eigen::VectorXd own = solved(hidden, wanted(number, hidden));
        const double u_mgal = error_mgal(own);
        parts.col(static_cast<Index>(number)) = own / (u_mgal > 0.0 ? u_mgal : 1.0);
    }
    return parts.transpose() * information_ * parts;
}

Eigen::VectorXd DayAdjustment::parts_of_group(const Eigen::VectorXd& common,
                                              std::size_t group) const {
    Eigen::VectorXd all(groups_[group].answer.rows() + common.size());
    all << groups_[group].answer * common, common;
    return all;
}

Eigen::VectorXd DayAdjustment::parts_of(const Eigen::VectorXd& common, std::size_t survey) const {
    std::vector<Index> places = problem_->places_in_group(survey, true);
    places.erase(places.begin());  // the readings
    return parts_of_group(common, problem_->group_of(survey))(places);
}

void DayAdjustment::set_sources(GravityEstimate& gravity, const Eigen::VectorXd& parts) const {
    std::array<double, kErrorSources> squares{};
    const auto square = [&squares](ErrorSource source) -> double& {
        return squares.at(static_cast<std::size_t>(source));
    };
    for (std::size_t k = 0; k < sources_.size(); ++k)
        square(sources_[k]) += std::pow(parts(static_cast<Index>(k)), 2);
    for (std::size_t group = 0; group < groups_.size(); ++group) {
        const Eigen::VectorXd all = parts_of_group(parts, group);
        for (std::size_t k = 0; k < groups_[group].sources.size(); ++k)
            square(groups_[group].sources[k]) += std::pow(all(static_cast<Index>(k)), 2);
    }
    for (const DayProblem::Group& group : problem_->groups())
        if (group.of_white_surveys.size() > 0)
            square(ErrorSource::white) +=
                parts.dot(group.of_white_surveys.topLeftCorner(parts.size(), parts.size()) * parts);
    // The noise is split with the weights of the readings, W'X s, where W is the whitening.
    for (std::size_t k = 0; k < surveys_.size(); ++k) {
        const SurveyPart& survey = surveys_[k];
        const std::vector<reading::DayBin>& bins = problem_->surveys()[k].record->bins;
        const DayNoise noise = problem_->own_noise(found_.expected, k);
        const Eigen::VectorXd whitened =
            survey.columns.rightCols(survey.columns.cols() - 1) * parts_of(parts, k);
        Eigen::MatrixXd whitening = Eigen::MatrixXd::Identity(whitened.size(), whitened.size());
        problem_->of(k).whiten(noise, whitening);
        const Eigen::VectorXd weights = whitening.transpose() * whitened;
        std::vector<double> of_set_up(bins.back().set_up + 1);
        double white = 0.0, placement = 0.0;
        for (std::size_t i = 0; i < bins.size(); ++i) {
            const double weight = weights(static_cast<Index>(i));
            of_set_up[bins[i].set_up] += weight;
            white += std::pow(weight * noise.white_mgal, 2) *
                     static_cast<double>(reading::kBinSamples) /
                     static_cast<double>(bins[i].times.size());
        }
        for (const double weight : of_set_up)
            placement += std::pow(weight * noise.placement_mgal, 2);
        square(ErrorSource::white) += white;
        square(ErrorSource::placement) += placement;
        square(ErrorSource::flicker) += std::max(0.0, whitened.squaredNorm() - white - placement);
    }
    std::ranges::transform(squares, gravity.parts_mgal.begin(),
                           [](double value) { return std::sqrt(value); });
    if (surveys_.empty()) return;
    const Eigen::VectorXd of_first = parts_of(parts, 0);
    const Index lags =
        surveys_.front().columns.cols() - 1 - kLags - std::ssize(problem_->of(0).base_mgal());
    for (const UnitParameter& parameter : unit_parameters())
        gravity.shared_mgal.push_back(parameter.place < kLags ? of_first(lags + parameter.place)
                                                              : of_first(parameter.place - kLags));
    gravity.shared_mgal.push_back(of_first(static_cast<Index>(DayTerm::scale)));
    for (const Gravity& other : gravities_)
        gravity.of_gravities_mgal.push_back(other.held >= 0 ? parts(other.held) : 0.0);
}

Eigen::MatrixXd DayAdjustment::covariance_of(std::size_t survey) const {
    const GroupPart& group = groups_[problem_->group_of(survey)];
    const Index own = group.answer.rows(), fitted = covariance_.rows();
    const Eigen::MatrixXd answer = group.answer.leftCols(fitted);
    Eigen::MatrixXd all(own + fitted, own + fitted);
    all << group.covariance + answer * covariance_ * answer.transpose(), answer * covariance_,
        (answer * covariance_).transpose(), covariance_;
    std::vector<Index> places = problem_->places_in_group(survey, true);
    places.erase(places.begin());
    const Index estimated = problem_->of(survey).estimated();
    const Index lags = std::ssize(places) - kLags - std::ssize(problem_->of(survey).base_mgal());
    places.erase(places.begin() + lags + kLags, places.end());
    places.erase(places.begin() + estimated, places.begin() + lags);
    return all(places, places);
}

}  // namespace a351::corrector::whole_day
