// SPDX-License-Identifier: GPL-3.0-or-later
// A reader of HTTP for one request. Heads that parsers read differently (folded lines, blanks
// before a colon) are refused, since a proxy in front might have understood another request.
#include "extensions/wire/mjpeg_session.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "extensions/wire/picture_files.h"

namespace ispace::wire {

namespace {

constexpr std::string_view kBoundary = "ispace-picture";
constexpr int kOk = 200, kBad = 400, kForbidden = 403, kNotFound = 404, kNoMethod = 405,
              kTooLong = 431, kNoEncoder = 503;

std::string_view reasonOf(int status) {
    switch (status) {
        case kOk:
            return "OK";
        case kForbidden:
            return "Forbidden";
        case kNotFound:
            return "Not Found";
        case kNoMethod:
            return "Method Not Allowed";
        case kTooLong:
            return "Request Header Fields Too Large";
        case kNoEncoder:
            return "Service Unavailable";
        default:
            return "Bad Request";
    }
}

std::string headerOf(int status, std::string_view type) {
    std::string out = "HTTP/1.1 " + std::to_string(status) + " ";
    out.append(reasonOf(status)).append("\r\nConnection: close\r\nCache-Control: no-store\r\n");
    out.append("X-Content-Type-Options: nosniff\r\nContent-Type: ").append(type).append("\r\n");
    return out;
}

/// Headers of a picture, in a stream or alone.
std::string headerOf(const PictureFile& file) {
    std::string out = "Content-Length: " + std::to_string(file.bytes.size());
    out.append("\r\nX-Timestamp: ").append(formatMilliseconds(file.time));
    return out.append("\r\nX-Sequence: ").append(std::to_string(file.seq)).append("\r\n\r\n");
}

std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

bool isBlank(char c) { return c == ' ' || c == '\t'; }

/// True where parsers disagree about the header's name: blanks before it (obsolete line folding) or
/// after it.
bool isDoubtful(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (line.empty() || colon == 0) return false;
    return isBlank(line.front()) || (colon != std::string_view::npos && isBlank(line[colon - 1]));
}

bool isHeader(std::string_view line, std::string_view name) {
    return line.size() > name.size() && line[name.size()] == ':' &&
           std::equal(name.begin(), name.end(), line.begin(), [](char a, char b) {
               return a == std::tolower(static_cast<unsigned char>(b));
           });
}

/// True for names that a foreign DNS server could resolve to 127.0.0.1: they contain a dot and,
/// unlike addresses, letters.
bool isStranger(std::string_view host) {
    while (!host.empty() && isBlank(host.front())) host.remove_prefix(1);
    while (!host.empty() && isBlank(host.back())) host.remove_suffix(1);
    if (host.starts_with('[')) return false;
    host = host.substr(0, host.find(':'));
    if (host.find('.') == std::string_view::npos) return false;
    return host.find_first_not_of("0123456789.") != std::string_view::npos;
}

}  // namespace

PictureRequest parsePictureRequest(std::string_view head) {
    const std::string_view first = takeLine(head);
    const std::size_t space = first.find(' '), end = first.rfind(' ');
    const bool is_http = end != space && first.substr(end + 1).starts_with("HTTP/1.");
    PictureRequest request;
    if (space == std::string_view::npos || !is_http) {
        request.refusal = kBad;
        return request;
    }
    const std::string_view method = first.substr(0, space);
    const std::string_view target = first.substr(space + 1, end - space - 1);
    const std::string_view path = target.substr(0, target.find('?'));
    request.head = method == "HEAD";
    constexpr std::array<std::string_view, 4> kStreams = {"/", "/stream", "/stream.mjpg", "/video"};
    const bool asks_one = path.substr(0, path.find('.')) == "/snapshot" ||
                          (path == "/" && target.ends_with("?action=snapshot"));
    if (asks_one)
        request.kind = PictureRequest::Kind::Snapshot;
    else if (std::find(kStreams.begin(), kStreams.end(), path) == kStreams.end())
        request.refusal = kNotFound;
    if (method != "GET" && method != "HEAD") request.refusal = kNoMethod;
    while (!head.empty()) {
        const std::string_view line = takeLine(head);
        if (isDoubtful(line)) request.refusal = kBad;
        constexpr std::string_view kHost = "host";
        if (isHeader(line, kHost) && isStranger(line.substr(kHost.size() + 1)))
            request.refusal = kForbidden;
    }
    return request;
}

MjpegSession::MjpegSession(WireHost& host, std::string sensor)
    : host_(&host), id_(std::move(sensor)) {}

void MjpegSession::receive(std::string_view bytes) {
    if (request_) return;
    head_ += bytes;
    // Skip empty lines before a request.
    head_.erase(0, std::min(head_.find_first_not_of("\r\n"), head_.size()));
    const std::size_t end = std::min(head_.find("\r\n\r\n"), head_.find("\n\n"));
    if (std::min(end, head_.size()) > kMaxHead) return refuse(kTooLong, "the request is too long");
    if (end == std::string::npos) return;
    request_ = parsePictureRequest(std::string_view(head_).substr(0, end));
    std::string().swap(head_);
    setUnderstood();
    answer(*request_);
}

void MjpegSession::refuse(int status, std::string_view reason) {
    request_ = PictureRequest{.refusal = status};
    std::string body(reason);
    body += '\n';
    send(headerOf(status, "text/plain; charset=utf-8") +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    close();
}

void MjpegSession::answer(const PictureRequest& request) {
    switch (request.refusal) {
        case 0:
            break;
        case kForbidden:
            return refuse(kForbidden, "ask by the address of this machine, or by localhost");
        case kNotFound:
            return refuse(kNotFound, "there is / with the stream, and /snapshot");
        case kNoMethod:
            return refuse(kNoMethod, "pictures can be got, with GET");
        default:
            return refuse(kBad, "this is no HTTP");
    }
    if (request.kind == PictureRequest::Kind::Stream) {
        std::string type = "multipart/x-mixed-replace; boundary=";
        send(headerOf(kOk, type.append(kBoundary)) + "\r\n");
        if (request.head) return close();
    }
    show();
}

void MjpegSession::ended() {
    if (!request_) close();
}

void MjpegSession::stepped(std::size_t unsent) {
    if (!request_) return;
    // Pictures are large: wait until the previous one is sent.
    if (unsent == 0) show();
}

void MjpegSession::show() {
    World& world = host_->world();
    const auto sensor = world.sensorNamed(id_);
    if (!sensor || !isHeavy(world.sensors()[*sensor])) return close();
    const bool streams = request_->kind == PictureRequest::Kind::Stream;
    // A paused world loses no time.
    if (!coming_)
        coming_ = host_->pictures().newest(world, *sensor, std::chrono::steady_clock::now(),
                                           host_->isPaused(), [this](auto work, auto deliver) {
                                               host_->runInBackground(std::move(work),
                                                                      std::move(deliver));
                                           });
    if (!coming_ || !(coming_->file || coming_->failure)) return;
    const auto asked = std::exchange(coming_, nullptr);
    try {
        if (asked->failure) std::rethrow_exception(asked->failure);
    } catch (const FormatError& missing) {
        return streams ? close() : refuse(kNoEncoder, missing.what());
    } catch (const std::bad_alloc&) {
        return streams ? close() : refuse(kNoEncoder, "there is not enough memory for this");
    }
    const auto file = asked->file;
    if (file == sent_) return;
    sent_ = file;
    if (streams) {
        send("--" + std::string(kBoundary) + "\r\nContent-Type: " + std::string(file->type) +
             "\r\n" + headerOf(*file));
        send(file->bytes);
        return send("\r\n");
    }
    send(headerOf(kOk, file->type) + headerOf(*file));
    if (!request_->head) send(file->bytes);
    close();
}

namespace {

std::string refusalOfMjpeg(const World& world, std::string_view id) {
    const auto sensor = world.sensorNamed(id);
    if (sensor && world.sensors()[*sensor].tryAs<Ranger>() != nullptr) return "";
    return refusalOfSensor(world, "camera", id);
}

std::unique_ptr<WireSession> openMjpeg(WireHost& host, const std::string& id) {
    return std::make_unique<MjpegSession>(host, id);
}

}  // namespace

const WireProtocol kMjpeg{
    .name = "mjpeg",
    .device = "CAMERA",
    .help = "pictures of a camera or a 3-D ranger over HTTP, as of a network camera",
    .port = 8080,
    .clients = 8,
    .refusal = refusalOfMjpeg,
    .open = openMjpeg};

}  // namespace ispace::wire
