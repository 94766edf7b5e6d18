// Makes the bags of tests/io/source/data with encoders that are not ours. They are in the tree; to make them again:
//   npm install @mcap/core@2.2.2 @foxglove/rosmsg @foxglove/rosmsg2-serialization @foxglove/rosmsg-msgs-common \
//     @foxglove/wasm-zstd lz4js sql.js
//   node make_ros2_bags.mjs tests/io/source/data
// Every bag has three pairs of mono8 images of 8×6 pixels in rows of 10 bytes, of one grey level each (left 10 + i,
// right 110 + i, the padding 99), at 1700000000 + 0.1 i s, the right one 2 ms later; camera_info of a rectified rig (f 100
// px, baseline 0.12 m); and fixes of a receiver, the second without a position.
import { McapWriter } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import common from "@foxglove/rosmsg-msgs-common";
import zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4js";
import initSqlite from "sql.js";
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";

const { ros2humble } = common;
const start = 1700000000;
const stamp = (seconds) => {
  const whole = Math.floor(seconds);
  return { sec: start + whole, nanosec: Math.round(1e9 * (seconds - whole)), nsec: Math.round(1e9 * (seconds - whole)) };
};
const header = (seconds) => ({ stamp: stamp(seconds), frame_id: "camera" });
const nanoseconds = (seconds) => BigInt(start) * 1000000000n + BigInt(Math.round(1e9 * seconds));

function definitions(type) {
  const found = [];
  const add = (name) => {
    const definition = ros2humble[name];
    if (!definition || found.some((one) => one.name === definition.name)) return;
    found.push(definition);
    for (const field of definition.definitions) if (field.isComplex) add(field.type);
  };
  add(type);
  return found;
}
const writers = new Map();
function encode(type, message) {
  if (!writers.has(type)) writers.set(type, new MessageWriter(definitions(type)));
  return writers.get(type).writeMessage(message);
}

function image(seconds, level) {
  const data = new Uint8Array(60).fill(99);
  for (let v = 0; v < 6; ++v) data.fill(level, 10 * v, 10 * v + 8);
  return { header: header(seconds), height: 6, width: 8, encoding: "mono8", is_bigendian: 0, step: 10, data };
}
function png(seconds, level) {
  const chunk = (name, bytes) => {
    const body = Buffer.concat([Buffer.from(name), bytes]);
    const all = Buffer.alloc(body.length + 8);
    all.writeUInt32BE(bytes.length, 0);
    body.copy(all, 4);
    all.writeUInt32BE(crc32(body), body.length + 4);
    return all;
  };
  const head = Buffer.from([0, 0, 0, 32, 0, 0, 0, 32, 8, 0, 0, 0, 0]);
  const rows = Buffer.alloc(33 * 32, level);
  for (let v = 0; v < 32; ++v) rows[33 * v] = 0;
  const data = Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]), chunk("IHDR", head),
                              chunk("IDAT", zlib.deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
  return { header: header(seconds), format: "mono8; png compressed", data: new Uint8Array(data) };
}
function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}
function cameraInfo(shift) {
  return {
    header: header(0), height: 6, width: 8, distortion_model: "plumb_bob", d: [0, 0, 0, 0, 0],
    k: [100, 0, 4, 0, 100, 3, 0, 0, 1], r: [1, 0, 0, 0, 1, 0, 0, 0, 1], p: [100, 0, 4, shift, 0, 100, 3, 0, 0, 0, 1, 0],
    binning_x: 0, binning_y: 0, roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false },
  };
}
function fix(i) {
  return {
    header: header(0.1 * i), status: { status: i === 1 ? -1 : 0, service: 1 }, latitude: 48 + 1e-5 * i, longitude: 11.5,
    altitude: 520.25, position_covariance: new Array(9).fill(0), position_covariance_type: 0,
  };
}

function recording(compressed) {
  const type = compressed ? "sensor_msgs/CompressedImage" : "sensor_msgs/Image";
  const name = (side) => `/stereo/${side}/image_raw${compressed ? "/compressed" : ""}`;
  const make = compressed ? png : image;
  const messages = [
    ["/stereo/left/camera_info", "sensor_msgs/CameraInfo", 0, cameraInfo(0)],
    ["/stereo/right/camera_info", "sensor_msgs/CameraInfo", 0, cameraInfo(-12)],
  ];
  for (let i = 0; i < 3; ++i) {
    messages.push([name("left"), type, 0.1 * i, make(0.1 * i, 10 + i)]);
    messages.push([name("right"), type, 0.1 * i + 0.002, make(0.1 * i + 0.002, 110 + i)]);
    messages.push(["/gnss/fix", "sensor_msgs/NavSatFix", 0.1 * i + 0.003, fix(i)]);
    messages.push(["/chatter", "std_msgs/String", 0.1 * i + 0.003, { data: "not read" }]);
  }
  return messages.map(([topic, kind, seconds, message]) => ({
    topic, type: kind.replace("/", "/msg/"), received: nanoseconds(seconds) + 1000000n, data: encode(kind, message),
  }));
}

async function writeMcap(file, messages, options) {
  const pieces = [];
  let size = 0;
  const writable = {
    position: () => BigInt(size),
    write: async (bytes) => {
      pieces.push(Uint8Array.from(bytes));
      size += bytes.byteLength;
    },
  };
  const writer = new McapWriter({ writable, chunkSize: 400, ...options });
  await writer.start({ profile: "ros2", library: "make_ros2_bags" });
  const channels = new Map();
  for (const { topic, type, received, data } of messages) {
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema({ name: type, encoding: "ros2msg", data: new Uint8Array() });
      channels.set(topic, await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() }));
    }
    await writer.addMessage({ channelId: channels.get(topic), sequence: 0, logTime: received, publishTime: received, data });
  }
  await writer.end();
  fs.writeFileSync(file, Buffer.concat(pieces));
}

function writeRosbag2(SQL, folder, messages, mode) {
  fs.mkdirSync(folder, { recursive: true });
  const database = new SQL.Database();
  database.run("PRAGMA page_size = 512; VACUUM;");
  database.run(`CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
    CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
                        offered_qos_profiles TEXT NOT NULL);
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);`);
  const topics = new Map();
  for (const { topic, type, received, data } of messages) {
    if (!topics.has(topic)) {
      topics.set(topic, { id: topics.size + 1, type, count: 0 });
      database.run("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", [topics.get(topic).id, topic, type]);
    }
    const entry = topics.get(topic);
    ++entry.count;
    const bytes = mode === "MESSAGE" ? zstd.compress(data) : data;
    database.run("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, CAST(? AS INTEGER), ?)",
                 [entry.id, received.toString(), bytes]);
  }
  const name = `${path.basename(folder)}_0.db3${mode === "FILE" ? ".zstd" : ""}`;
  const bytes = database.export();
  fs.writeFileSync(path.join(folder, name), mode === "FILE" ? zstd.compress(bytes) : bytes);
  const lines = ["rosbag2_bagfile_information:", "  version: 5", "  storage_identifier: sqlite3", "  relative_file_paths:",
                 `    - ${name}`, "  duration:", "    nanoseconds: 203000000", "  starting_time:",
                 "    nanoseconds_since_epoch: 1700000000001000000", `  message_count: ${messages.length}`,
                 "  topics_with_message_count:"];
  for (const [topic, { type, count }] of topics) {
    lines.push("    - topic_metadata:", `        name: ${topic}`, `        type: ${type}`,
               "        serialization_format: cdr", '        offered_qos_profiles: ""', `      message_count: ${count}`);
  }
  lines.push(`  compression_format: "${mode ? "zstd" : ""}"`, `  compression_mode: "${mode}"`);
  fs.writeFileSync(path.join(folder, "metadata.yaml"), lines.join("\n") + "\n");
}

const output = process.argv[2];
fs.mkdirSync(output, { recursive: true });
await zstd.isLoaded;
const SQL = await initSqlite();
const messages = recording(false);
await writeMcap(path.join(output, "zstd.mcap"), messages,
                { compressChunk: (data) => ({ compression: "zstd", compressedData: zstd.compress(data) }) });
await writeMcap(path.join(output, "lz4.mcap"), recording(true),
                { compressChunk: (data) => ({ compression: "lz4", compressedData: lz4.compress(data) }) });
await writeMcap(path.join(output, "unindexed.mcap"), messages,
                { useChunks: false, useChunkIndex: false, useMessageIndex: false, useStatistics: false,
                  useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false });
writeRosbag2(SQL, path.join(output, "rosbag2"), messages, "");
writeRosbag2(SQL, path.join(output, "rosbag2_messages"), messages, "MESSAGE");
writeRosbag2(SQL, path.join(output, "rosbag2_file"), messages, "FILE");
