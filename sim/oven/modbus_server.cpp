#include "sim/oven/modbus_server.hpp"

#include <utility>

namespace a351::sim::oven {
namespace {

using namespace std::chrono_literals;

constexpr int kUnit = 1;                   ///< Unit number, 1 ... 99: factory setting.
constexpr Nanoseconds kAnswerWait = 20ms;  ///< "Send data wait time": factory setting.
constexpr Nanoseconds kRestartTime = 5s;   ///< E5EK manual, section 6.4.
constexpr Nanoseconds kFaultDelay = 1s;    ///< Lateness of a delayed answer: chosen.
constexpr std::size_t kLongestRequest = 264;
constexpr std::size_t kBabble = 64;
constexpr std::byte kBroadcast{0};
constexpr std::uint16_t kCommandAddress = 0x0000, kOtherCommandAddress = 0xFFFF;

/// Returns the time on the line of some characters.
constexpr Nanoseconds characters(double count) {
    constexpr double kBitsPerCharacter = 11.0;
    return from_seconds(count * kBitsPerCharacter / ModbusServer::kBaud);
}

/// Silence that ends a frame: Modbus over Serial Line V1.02, 2.5.1.1.
constexpr Nanoseconds kSilence = characters(3.5);

std::size_t index_of(Fault fault) { return static_cast<std::size_t>(fault); }

std::vector<std::byte> refused(std::span<const std::byte> request, Refusal reason) {
    return {request[0], request[1] | std::byte{0x80}, std::byte(reason)};
}

/// Returns the answer to a write: the head of the request.
std::vector<std::byte> confirmed(std::span<const std::byte> request) {
    return {request.begin(), request.begin() + 6};
}

std::vector<std::byte> nonsense(std::uint16_t seed) {
    std::vector<std::byte> bytes(kBabble);
    std::uint32_t state = seed;
    for (std::byte& byte : bytes) {
        state = state * 1'664'525U + 1'013'904'223U;  // Numerical Recipes in C, 2nd ed., 7.1.
        byte = static_cast<std::byte>(state >> 24);
    }
    return bytes;
}

}  // namespace

void ModbusServer::restart(Nanoseconds now) {
    controller_.restart();
    forget_answer();
    if (!received_.empty()) ignore_run(report_.ignored);
    is_restarting_ = true;
    restarted_at_ = now;
}

void ModbusServer::forget_answer() {
    if (answer_) ++report_.answers_lost;
    answer_.reset();
}

/// Ignores all bytes received from the last silence to the next and counts them once.
void ModbusServer::ignore_run(std::int64_t& counter) {
    ++counter;
    received_.clear();
    is_ignoring_ = true;
}

void ModbusServer::receive(std::span<const std::byte> bytes, Nanoseconds now) {
    if (bytes.empty()) return;
    end_by_silence(now);
    last_byte_ = now;
    if (is_restarting_ && now - restarted_at_ >= kRestartTime) is_restarting_ = false;
    if (is_ignoring_) return;
    if (answer_ || is_restarting_ || !controller_.speaks_modbus())
        return ignore_run(report_.ignored);
    received_.insert(received_.end(), bytes.begin(), bytes.end());
    take_requests(now);
}

void ModbusServer::receive_noise(Nanoseconds now) {
    end_by_silence(now);
    last_byte_ = now;
    if (!is_ignoring_) ignore_run(report_.unreadable);
}

void ModbusServer::end_by_silence(Nanoseconds now) {
    if (now - last_byte_ <= kSilence) return;
    is_ignoring_ = false;
    if (received_.empty()) return;
    const std::vector<std::byte> frame = std::exchange(received_, {});
    // A rest with a known function is too short for that function.
    if (is_sealed(frame) && !is_known_function(frame[1])) {
        handle(frame, now);
    } else {
        ++report_.unreadable;
    }
}

void ModbusServer::take_requests(Nanoseconds now) {
    while (!received_.empty()) {
        const std::optional<std::size_t> length = request_length(received_);
        if (received_.size() < length.value_or(kLongestRequest)) return;
        if (!length || !is_sealed(std::span(received_).first(*length)))
            return ignore_run(report_.unreadable);
        const auto end = received_.begin() + static_cast<std::ptrdiff_t>(*length);
        const std::vector<std::byte> request(received_.begin(), end);
        received_.erase(received_.begin(), end);
        handle(request, now);
        if ((answer_ || is_restarting_) && !received_.empty()) ignore_run(report_.ignored);
    }
}

void ModbusServer::handle(std::span<const std::byte> request, Nanoseconds now) {
    if (request[0] == kBroadcast) {
        ++report_.broadcasts;
        static_cast<void>(answer_to(request, now));
        return;
    }
    if (std::to_integer<int>(request[0]) != kUnit) {
        ++report_.for_other_units;
        return;
    }
    const std::optional<Fault> fault = next_fault();
    if (fault == Fault::silence) {
        spend(*fault);
        ++report_.faults[index_of(*fault)];
        return;
    }
    Answer answer{{}, {}, fault, false};
    if (fault == Fault::babble) {
        answer.bytes = nonsense(modbus_crc(request.first(request.size() - 2)));
    } else {
        std::vector<std::byte> frame = fault == Fault::exception
                                           ? refused(request, Refusal::operation)
                                           : answer_to(request, now);
        if (frame.empty()) {
            ++report_.resets;
            return;
        }
        answer.is_exception = (frame[1] & std::byte{0x80}) != std::byte{0};
        if (fault == Fault::wrong_unit) frame[0] = static_cast<std::byte>(kUnit + 1);
        answer.bytes = sealed(std::move(frame));
    }
    if (fault) spend(*fault);
    reply(std::move(answer), request.size(), now);
}

/// Executes a request.  @return the answer; empty after a software reset.
std::vector<std::byte> ModbusServer::answer_to(std::span<const std::byte> request,
                                               Nanoseconds now) {
    const std::byte function = request[1];
    if (!is_known_function(function)) return refused(request, Refusal::function);
    const std::uint16_t address = word_at(request, 2), second = word_at(request, 4);
    std::optional<Refusal> refusal;
    if (function == kReadRegisters) {
        const auto result = controller_.read(address, second);
        if (const Refusal* reason = std::get_if<Refusal>(&result)) return refused(request, *reason);
        const auto& words = std::get<std::vector<std::uint16_t>>(result);
        std::vector<std::byte> answer = {request[0], function, std::byte(2 * words.size())};
        for (const std::uint16_t word : words) append_word(answer, word);
        return answer;
    }
    if (function == kEcho) {
        if (address != 0) refusal = Refusal::data;  // The sub-function.
    } else if (function == kWriteRegisters) {
        const std::size_t byte_count = std::to_integer<std::size_t>(request[6]);
        std::vector<std::uint16_t> words;
        for (std::size_t i = 0; i + 1 < byte_count; i += 2)
            words.push_back(word_at(request, 7 + i));
        if (find_variable(address) != nullptr && byte_count != std::size_t{2} * second) {
            refusal = Refusal::data;
        } else {
            refusal = controller_.write(address, words);
        }
    } else if (address == kCommandAddress || address == kOtherCommandAddress) {
        const auto command = static_cast<std::uint8_t>(second >> 8);
        refusal = controller_.operate(command, static_cast<std::uint8_t>(second));
        if (!refusal && command == kSoftwareReset) {
            restart(now);
            return {};
        }
    } else {
        refusal = controller_.write(address, std::span(&second, 1));
    }
    return refusal ? refused(request, *refusal) : confirmed(request);
}

std::optional<Fault> ModbusServer::next_fault() const {
    for (std::size_t i = 0; i < kOvenFaultCount; ++i) {
        if (remaining_[i] != 0) return static_cast<Fault>(i);
    }
    return std::nullopt;
}

void ModbusServer::spend(Fault fault) {
    int& remaining = remaining_[index_of(fault)];
    if (remaining > 0) --remaining;
}

void ModbusServer::reply(Answer answer, std::size_t request_size, Nanoseconds now) {
    if (answer.fault == Fault::crc_error) answer.bytes.back() ^= std::byte{1};
    if (answer.fault == Fault::truncated) answer.bytes.resize(answer.bytes.size() / 2);
    const double on_the_line = static_cast<double>(request_size + answer.bytes.size());
    answer.due = now + characters(on_the_line) + kAnswerWait;
    if (answer.fault == Fault::delay) answer.due += kFaultDelay;
    answer_ = std::move(answer);
}

std::vector<std::byte> ModbusServer::advance_to(Nanoseconds now, bool has_master) {
    end_by_silence(now);
    if (!answer_ || now < answer_->due) return {};
    if (!has_master) {
        forget_answer();
        return {};
    }
    const Answer answer = *std::exchange(answer_, std::nullopt);
    if (answer.fault) {
        ++report_.faults[index_of(*answer.fault)];
    } else {
        ++report_.answers;
        if (answer.is_exception) ++report_.exceptions;
    }
    return answer.bytes;
}

std::optional<Nanoseconds> ModbusServer::next_due() const {
    if (answer_) return answer_->due;
    if (!received_.empty()) return last_byte_ + kSilence + 1ns;
    return std::nullopt;
}

}  // namespace a351::sim::oven
