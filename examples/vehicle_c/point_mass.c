/* A vehicle for karst in one file of C, without a dependency: a point mass in a room, with a LiDAR.
 *
 *   cc -O2 -std=c11 -o point_mass point_mass.c -lm && ./point_mass tcp:127.0.0.1:14660
 *   karst vehicle check tcp:127.0.0.1:14660 --fly
 *   karst fly --set vehicle=socket --set socket.address=tcp:14660 \
 *             --set localization.source=pose_sensor --time 60s
 *
 * It flies in lockstep and in real time. The protocol is that of docs/vehicle_protocol.md, version 1, for a
 * machine whose numbers are little-endian. Replace the part "the vehicle" to put one of your own behind it.
 */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <errno.h>
#include <math.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

enum { HELLO = 1, START, RUN, RESUME, COMMAND, PING, BYE };
enum { WELCOME = 32, REFUSE, CHECKS, SCHEDULE, PAUSE, DONE, PONG };
enum { IMU = 48, MAGNETOMETER, BAROMETER, POSE, BATTERY, LIDAR, GROUND = 57, LIFT_OFF, AUTHORITY, LOST };
enum { LOCKSTEP = 0, REAL_TIME = 1 };
static const uint32_t kMagic = 0x4556524b;
static const uint16_t kVersion = 1;
static const double kPi = 3.14159265358979323846;
static const int64_t kMs = 1000000, kSecond = 1000000000;

/* -- messages
 * ------------------------------------------------------------------------------------------------------ */

enum { LAST_WORD = 256 }; /* bytes that are kept free for it */
typedef struct {
  unsigned char bytes[1 << 18];
  size_t size, begin; /* begin: of the message that is being written */
  size_t sent;        /* of the first messages: what is before is gone */
} Out;

static void put(Out* o, const void* data, size_t size) {
  memcpy(o->bytes + o->size, data, size);
  o->size += size;
}
static void put_u8(Out* o, uint8_t v) { put(o, &v, 1); }
static void put_u16(Out* o, uint16_t v) { put(o, &v, 2); }
static void put_u32(Out* o, uint32_t v) { put(o, &v, 4); }
static void put_i64(Out* o, int64_t v) { put(o, &v, 8); }
static void put_f32(Out* o, float v) { put(o, &v, 4); }
static void put_f64(Out* o, double v) { put(o, &v, 8); }
static void put_vec3(Out* o, const double v[3]) { put(o, v, 24); }
static void put_text(Out* o, const char* text) {
  put_u16(o, (uint16_t)strlen(text));
  put(o, text, strlen(text));
}
static void begin(Out* o, uint16_t type) {
  o->begin = o->size;
  put_u32(o, 0);
  put_u16(o, type);
  put_u16(o, 0);
}
static void end(Out* o) {
  const uint32_t size = (uint32_t)(o->size - o->begin - 8);
  memcpy(o->bytes + o->begin, &size, 4);
}

typedef struct {
  double rate[3], thrust_n;
  bool armed;
} Command;

/* -- the vehicle
 * --------------------------------------------------------------------------------------------------- */

static const double kGravity = 9.81, kMass_kg = 1.5, kMaxThrust_n = 30, kMaxRate = 6, kRadius_m = 0.3,
                    kDrag = 0.2;
static const double kRoomMin[3] = {-4, -3, 0}, kRoomMax[3] = {8, 5, 4};
static const double kStanding_m = 0.1; /* of the body's centre above the floor */
static const double kBattery_wh = 40, kHover_w = 150;
#define COLUMNS 360
#define CHANNELS 16
static const float kLidarMin_m = 0.3f, kLidarMax_m = 30;
#define STEP (5 * kMs)
#define LIDAR_PERIOD (100 * kMs)
#define COMMAND_TIMEOUT (500 * kMs)

typedef struct {
  double p[3], v[3], q[4]; /* world frame; q is x y z w, body to world */
  double force[3], rate[3];
  bool standing, lost;
  Command command;
  int64_t commanded_at;
  double energy_wh;
} Vehicle;

static void rotate(const double q[4], const double v[3], double out[3]) {
  const double t[3] = {2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]),
                       2 * (q[0] * v[1] - q[1] * v[0])};
  out[0] = v[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1];
  out[1] = v[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2];
  out[2] = v[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0];
}
static void to_body(const double q[4], const double v[3], double out[3]) {
  const double inverse[4] = {-q[0], -q[1], -q[2], q[3]};
  rotate(inverse, v, out);
}
static void turn(double q[4], const double rate[3], double dt) {
  const double angle = sqrt(rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2]) * dt;
  if (angle < 1e-12) return;
  const double s = sin(angle / 2) * dt / angle, w = cos(angle / 2);
  const double a[3] = {rate[0] * s, rate[1] * s, rate[2] * s}, x = q[0], y = q[1], z = q[2], qw = q[3];
  q[0] = qw * a[0] + x * w + y * a[2] - z * a[1];
  q[1] = qw * a[1] - x * a[2] + y * w + z * a[0];
  q[2] = qw * a[2] + x * a[1] - y * a[0] + z * w;
  q[3] = qw * w - x * a[0] - y * a[1] - z * a[2];
  const double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int i = 0; i < 4; ++i) q[i] /= n;
}

static void vehicle_init(Vehicle* v) {
  memset(v, 0, sizeof *v);
  v->p[2] = kStanding_m;
  v->q[3] = 1;
  v->force[2] = kGravity;
  v->standing = true;
  v->energy_wh = kBattery_wh;
}

static void put_pose(Out* o, const double p[3], const double q[4]) {
  put_vec3(o, p);
  put(o, q, 32);
}

static double elevation(int channel) { return (30 - 4 * channel) * kPi / 180; }

static void put_description(Out* o) {
  const double origin[3] = {0, 0, 0}, start[3] = {0, 0, kStanding_m}, none[4] = {0, 0, 0, 1};
  put_text(o, "point mass");
  put_f64(o, kRadius_m);
  put_f64(o, kMass_kg);
  put_f64(o, kMaxThrust_n);
  put_f64(o, kMaxRate);
  put_u8(o, 1); /* there is a LiDAR */
  put_text(o, "room scanner");
  put_u32(o, COLUMNS);
  put_u32(o, CHANNELS);
  for (int i = 0; i < CHANNELS; ++i) put_f32(o, (float)elevation(i));
  put_f32(o, kLidarMin_m);
  put_f32(o, kLidarMax_m);
  put_i64(o, LIDAR_PERIOD);
  put_pose(o, origin, none);
  put_u32(o, 0); /* offsets of azimuth */
  put_f32(o, 0); /* beams begin at the origin */
  put_u32(o, 0); /* depth cameras */
  put_u8(o, 0);  /* colour camera */
  put_u8(o, 1);  /* pose sensor */
  put_u8(o, 0);  /* detector of objects */
  put_u8(o, 0);  /* steered by the core */
  put_pose(o, start, none);
}

static void put_stamped(Out* o, uint16_t type, int64_t now) {
  begin(o, type);
  put_i64(o, now);
  end(o);
}

static void put_battery(Out* o, const Vehicle* v, int64_t now) {
  begin(o, BATTERY);
  put_i64(o, now);
  put_f64(o, v->energy_wh);
  put_f64(o, v->energy_wh / kBattery_wh);
  put_f64(o, v->standing ? 5 : kHover_w);
  put_f64(o, 3600 * v->energy_wh / kHover_w);
  end(o);
}

static void put_scan(Out* o, const Vehicle* v, int64_t now) {
  begin(o, LIDAR);
  put_i64(o, now);
  put_u32(o, COLUMNS * CHANNELS);
  for (int c = 0; c < CHANNELS; ++c)
    for (int j = 0; j < COLUMNS; ++j) {
      const double a = kPi * (1 - 2 * (j + 0.5) / COLUMNS), e = elevation(c);
      const double beam[3] = {cos(e) * cos(a), cos(e) * sin(a), sin(e)};
      double d[3], nearest = INFINITY;
      rotate(v->q, beam, d);
      for (int i = 0; i < 3; ++i)
        if (fabs(d[i]) > 1e-9)
          nearest = fmin(nearest, ((d[i] > 0 ? kRoomMax[i] : kRoomMin[i]) - v->p[i]) / d[i]);
      /* NaN: no valid measurement; infinite: nothing within the range */
      put_f32(o, nearest < kLidarMin_m ? NAN : nearest > kLidarMax_m ? INFINITY : (float)nearest);
    }
  put_u32(o, COLUMNS * CHANNELS);
  for (int i = 0; i < COLUMNS * CHANNELS; ++i) put_f32(o, 0.5f); /* intensity */
  put_u32(o, 0);                                                 /* fired evenly */
  put_u32(o, 0);                                                 /* in the directions of the description */
  end(o);
}

static void lose(Vehicle* v, Out* o, int64_t now, const char* reason) {
  v->lost = true;
  begin(o, LOST);
  put_i64(o, now);
  put_u8(o, 1); /* contact */
  put_text(o, reason);
  end(o);
}

/* Floor and walls. */
static void touch(Vehicle* v, Out* o, int64_t now) {
  if (v->p[2] <= kStanding_m && v->v[2] < 0) {
    if (v->v[2] < -1.5) {
      lose(v, o, now, "fell to the floor");
      return;
    }
    const double n = hypot(v->q[2], v->q[3]); /* it stands level, with its heading */
    v->p[2] = kStanding_m;
    v->q[0] = v->q[1] = 0;
    v->q[2] /= n;
    v->q[3] /= n;
    memset(v->v, 0, sizeof v->v);
    v->standing = true;
    put_stamped(o, GROUND, now);
    return;
  }
  for (int i = 0; i < 3; ++i)
    if (v->p[i] < kRoomMin[i] + (i == 2 ? kStanding_m : kRadius_m) - 1e-9 ||
        v->p[i] > kRoomMax[i] - kRadius_m) {
      lose(v, o, now, "touched a wall");
      return;
    }
}

/* Without commands: level, and down at 0.5 m/s. */
static Command come_down(const Vehicle* v) {
  Command c = {{0, 0, 0}, 0, false};
  if (v->standing) return c;
  const double world_up[3] = {0, 0, 1};
  double up[3];
  to_body(v->q, world_up, up);
  c.rate[0] = -4 * up[1];
  c.rate[1] = 4 * up[0];
  c.thrust_n = fmax(0, kMass_kg * (kGravity + 2 * (-0.5 - v->v[2])));
  c.armed = true;
  return c;
}

static void put_measurements(Vehicle* v, Out* o, int64_t now) {
  begin(o, IMU);
  put_i64(o, now);
  put_vec3(o, v->force);
  put_vec3(o, v->rate);
  end(o);
  if (now % (20 * kMs) == 0) {
    const double field_ut[3] = {0, 20, -43};
    double seen[3];
    to_body(v->q, field_ut, seen);
    begin(o, MAGNETOMETER);
    put_i64(o, now);
    put_vec3(o, seen);
    end(o);
    begin(o, POSE);
    put_i64(o, now);
    put_pose(o, v->p, v->q);
    end(o);
  }
  if (now % (40 * kMs) == 0) {
    begin(o, BAROMETER);
    put_i64(o, now);
    put_f64(o, v->p[2] - kStanding_m);
    end(o);
  }
  if (now % (500 * kMs) == 0) put_battery(o, v, now);
  if (now % LIDAR_PERIOD == 0) put_scan(o, v, now);
}

/* Advances to `now`, by STEP. */
static void vehicle_step(Vehicle* v, Out* o, int64_t now) {
  if (v->lost) return;
  const double dt = (double)STEP / (double)kSecond;
  const Command c = now - v->commanded_at <= COMMAND_TIMEOUT ? v->command : come_down(v);
  const double thrust = c.armed ? fmin(fmax(c.thrust_n, 0), kMaxThrust_n) / kMass_kg : 0;
  const double before[3] = {v->v[0], v->v[1], v->v[2]};
  if (v->standing && thrust <= kGravity) {
    memset(v->v, 0, sizeof v->v);
    memset(v->rate, 0, sizeof v->rate);
  } else {
    if (v->standing) put_stamped(o, LIFT_OFF, now);
    v->standing = false;
    for (int i = 0; i < 3; ++i) v->rate[i] = fmin(fmax(c.rate[i], -kMaxRate), kMaxRate);
    turn(v->q, v->rate, dt);
    const double lift[3] = {0, 0, thrust};
    double a[3];
    rotate(v->q, lift, a);
    a[2] -= kGravity;
    for (int i = 0; i < 3; ++i) {
      a[i] -= kDrag * v->v[i];
      v->p[i] += v->v[i] * dt + a[i] * dt * dt / 2;
      v->v[i] += a[i] * dt;
    }
    touch(v, o, now);
  }
  const double felt[3] = {(v->v[0] - before[0]) / dt, (v->v[1] - before[1]) / dt,
                          (v->v[2] - before[2]) / dt + kGravity};
  to_body(v->q, felt, v->force);
  v->energy_wh = fmax(0, v->energy_wh - (v->standing ? 5 : kHover_w) * dt / 3600);
  put_measurements(v, o, now);
}

/* -- the connection
 * ------------------------------------------------------------------------------------------------ */

typedef struct {
  int fd;
  unsigned char bytes[8 + 65536];
  size_t size;
} Client;

typedef struct {
  uint16_t type;
  uint32_t size;
  unsigned char body[65536];
} Message;

static int64_t machine_time(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

/* Waits for the client: for what is no step of a vehicle that flies by itself. */
static bool send_all(int fd, Out* o) {
  while (o->sent < o->size) {
    const ssize_t n = send(fd, o->bytes + o->sent, o->size - o->sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    o->sent += (size_t)n;
  }
  o->size = o->sent = 0;
  return true;
}

/* Never waits. What does not fit stays in `o`. */
static bool send_some(int fd, Out* o) {
  while (o->sent < o->size) {
    const ssize_t n = send(fd, o->bytes + o->sent, o->size - o->sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
    if (n <= 0) return false;
    o->sent += (size_t)n;
  }
  memmove(o->bytes, o->bytes + o->sent, o->size - o->sent);
  o->size -= o->sent;
  o->sent = 0;
  return true;
}

/* Sends `from` behind what waits in `to`, without waiting. A client that is behind loses measurements and
 * pongs, but no change of state. */
static bool offer(int fd, Out* to, Out* from) {
  const bool behind = to->size > sizeof to->bytes / 4;
  for (size_t at = 0; at < from->size;) {
    uint32_t size;
    uint16_t type;
    memcpy(&size, from->bytes + at, 4);
    memcpy(&type, from->bytes + at + 4, 2);
    const size_t room = sizeof to->bytes - LAST_WORD - to->size;
    if (8 + size <= room && (!behind || type >= GROUND || type == DONE)) put(to, from->bytes + at, 8 + size);
    at += 8 + size;
  }
  from->size = 0;
  return send_some(fd, to);
}

/* A last word. */
static void tell(int fd, Out* o, uint16_t type, const char* text) {
  begin(o, type);
  put_text(o, text);
  end(o);
  send_some(fd, o);
}

/* 1: a message; 0: none within `wait_ms`; -1: the client is gone, or sends what is no message. */
static int next_message(Client* c, Message* m, int wait_ms) {
  for (;;) {
    if (c->size >= 8) {
      uint16_t zero;
      memcpy(&m->size, c->bytes, 4);
      memcpy(&m->type, c->bytes + 4, 2);
      memcpy(&zero, c->bytes + 6, 2);
      if (m->size > sizeof m->body || zero != 0) return -1;
      if (c->size >= 8 + m->size) {
        memcpy(m->body, c->bytes + 8, m->size);
        c->size -= 8 + m->size;
        memmove(c->bytes, c->bytes + 8 + m->size, c->size);
        return 1;
      }
    }
    struct pollfd one = {c->fd, POLLIN, 0};
    if (poll(&one, 1, wait_ms) <= 0) return 0;
    const ssize_t n = recv(c->fd, c->bytes + c->size, sizeof c->bytes - c->size, 0);
    if (n <= 0) return -1;
    c->size += (size_t)n;
  }
}

static void refuse_others(int listener) {
  static Out refusal;
  struct pollfd one = {listener, POLLIN, 0};
  while (poll(&one, 1, 0) > 0) {
    const int other = accept(listener, NULL, NULL);
    if (other < 0) return;
    refusal.size = refusal.sent = 0;
    tell(other, &refusal, REFUSE, "another client flies this vehicle");
    close(other);
  }
}

static Command command_of(const Message* m) {
  Command c;
  memcpy(c.rate, m->body, 24);
  memcpy(&c.thrust_n, m->body + 24, 8);
  c.armed = m->body[32] == 1;
  return c;
}

static void put_pong(Out* o, const Message* ping, int64_t received, int64_t sent) {
  begin(o, PONG);
  put(o, ping->body, 8);
  put_i64(o, received);
  put_i64(o, sent);
  end(o);
}

static void put_schedule(Out* o, uint32_t slot, int64_t due, int64_t period) {
  begin(o, SCHEDULE);
  put_u32(o, slot);
  put_i64(o, due);
  put_i64(o, period);
  end(o);
}

/* Slot 0 is the beginning, slot 1 each step. The client says when. */
static const char* fly_lockstep(int listener, Client* client, Vehicle* v, Out* o, Message* m) {
  int64_t now = 0;
  put_schedule(o, 0, 0, 0);
  put_schedule(o, 1, STEP, STEP);
  put_stamped(o, DONE, now);
  while (send_all(client->fd, o)) {
    int got;
    while ((got = next_message(client, m, 100)) == 0) refuse_others(listener);
    if (got < 0) return "the client is gone";
    if (m->type == BYE) return "the client left";
    if (m->type == COMMAND && m->size >= 33) {
      v->command = command_of(m);
      v->commanded_at = now;
    } else if (m->type == RUN && m->size == 12) {
      uint32_t slot;
      memcpy(&slot, m->body, 4);
      memcpy(&now, m->body + 4, 8);
      if (slot == 0) {
        put_stamped(o, GROUND, now);
        put_battery(o, v, now);
      } else {
        vehicle_step(v, o, now);
      }
      put_stamped(o, DONE, now);
    } else if (m->type == PING && m->size == 8) {
      put_pong(o, m, now, now);
    } else {
      return "a message that has no place here";
    }
  }
  return "the client is gone";
}

/* Steps by this machine's clock, whether the client reads or not: `o` keeps what could not be sent. A client
 * that is gone leaves a vehicle that comes down by itself. */
static const char* fly_real_time(int listener, Client* client, Vehicle* v, Out* o, Message* m) {
  static Out step;
  const int64_t begun = machine_time();
  int64_t now = 0, heard = 0;
  const char* leaving = NULL;
  step.size = 0;
  put_stamped(&step, DONE, 0);
  put_stamped(&step, GROUND, 0);
  put_battery(&step, v, 0);
  while (!leaving || !(v->standing || v->lost)) {
    while (now + STEP <= machine_time() - begun) {
      now += STEP;
      vehicle_step(v, &step, now);
      if (leaving) step.size = 0;
      if (!leaving && !offer(client->fd, o, &step)) leaving = "the client is gone";
    }
    refuse_others(listener);
    if (leaving) {
      poll(NULL, 0, 5);
      continue;
    }
    const int64_t left = now + STEP - (machine_time() - begun);
    const int got = next_message(client, m, left > 0 ? (int)(left / kMs) : 0);
    if (got < 0) leaving = "the client is gone";
    if (got > 0) heard = now;
    if (now - heard > 10 * kSecond) leaving = "the client is silent";
    if (got <= 0) continue;
    if (m->type == COMMAND && m->size >= 33) {
      v->command = command_of(m);
      v->commanded_at = now;
    } else if (m->type == PING && m->size == 8) {
      const int64_t received = machine_time() - begun;
      put_pong(&step, m, received, machine_time() - begun);
      if (!offer(client->fd, o, &step)) leaving = "the client is gone";
    } else {
      leaving = m->type == BYE ? "the client left" : "a message that has no place here";
    }
  }
  return leaving;
}

static const char* serve(int listener, Client* client, Out* o, Message* m, bool* flew) {
  static Vehicle vehicle;
  int clock = -1;
  vehicle_init(&vehicle);
  for (;;) {
    int got;
    while ((got = next_message(client, m, 100)) == 0) refuse_others(listener);
    if (got < 0) return "the client is gone, or sent what is no message";
    if (clock < 0) {
      uint32_t magic;
      uint16_t version;
      if (m->type != HELLO || m->size < 7) return "expected a greeting";
      memcpy(&magic, m->body, 4);
      memcpy(&version, m->body + 4, 2);
      if (magic != kMagic) return "expected a greeting";
      if (version != kVersion) return "this vehicle speaks version 1 of the protocol";
      clock = m->body[6];
      begin(o, WELCOME);
      put_u32(o, kMagic);
      put_u16(o, kVersion);
      put_u8(o, 1); /* flies in lockstep */
      put_u8(o, 1); /* and in real time */
      put_description(o);
      end(o);
    } else if (m->type == START) {
      *flew = true;
      return clock == LOCKSTEP ? fly_lockstep(listener, client, &vehicle, o, m)
                               : fly_real_time(listener, client, &vehicle, o, m);
    } else if (m->type == PING && m->size == 8) {
      put_pong(o, m, 0, 0);
    } else {
      return m->type == BYE ? "the client left" : "a message that has no place here";
    }
    if (!send_all(client->fd, o)) return "the client is gone";
  }
}

static int listen_at(const char* address) {
  int fd = -1;
  if (strncmp(address, "unix:", 5) == 0) {
    struct sockaddr_un name = {.sun_family = AF_UNIX};
    if (strlen(address + 5) >= sizeof name.sun_path) return -1;
    strcpy(name.sun_path, address + 5);
    fd = socket(AF_UNIX, SOCK_STREAM, 0);
    if (bind(fd, (struct sockaddr*)&name, sizeof name) != 0) return -1;
  } else if (strncmp(address, "tcp:", 4) == 0) {
    struct sockaddr_in name = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const char* colon = strrchr(address, ':');
    char host[64] = "127.0.0.1";
    const int on = 1;
    if (colon > address + 4) snprintf(host, sizeof host, "%.*s", (int)(colon - address - 4), address + 4);
    if (inet_pton(AF_INET, host, &name.sin_addr) != 1) return -1;
    name.sin_port = htons((uint16_t)atoi(colon + 1));
    fd = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd, (struct sockaddr*)&name, sizeof name) != 0) return -1;
  }
  return fd >= 0 && listen(fd, 8) == 0 ? fd : -1;
}

int main(int argc, char** argv) {
  static Out out;
  static Message message;
  static Client client;
  const int listener = argc == 2 ? listen_at(argv[1]) : -1;
  if (listener < 0) {
    fprintf(stderr, "usage: point_mass tcp:IPV4:PORT | unix:PATH (one that nothing listens at)\n");
    return 1;
  }
  printf("listening at %s\n", argv[1]);
  fflush(stdout);
  for (;;) {
    const int on = 1;
    client.fd = accept(listener, NULL, NULL);
    if (client.fd < 0) continue;
    bool flew = false;
    client.size = out.size = out.sent = 0;
    setsockopt(client.fd, IPPROTO_TCP, TCP_NODELAY, &on,
               sizeof on); /* fails on a unix socket, where it is not needed */
    const char* why = serve(listener, &client, &out, &message, &flew);
    tell(client.fd, &out, flew ? BYE : REFUSE, why);
    close(client.fd);
    printf("%s\n", why);
    fflush(stdout);
  }
}
