// node vda-5050-lib.js PCR: vehicles and a fleet manager that others wrote (npm's vda-5050-lib, VDA 5050 2.0) with `PCR serve` in between,
// over mosquitto. Two vehicles whose ways cross do three orders each; they never come nearer than their discs allow, one has to wait, and
// every order is told to be done. Run where the package is installed: others.sh.
"use strict";
const { spawn } = require("child_process"), fs = require("fs"), net = require("net"), os = require("os"), path = require("path");
const { createRequire } = require("module");
const { AgvController, MasterController, Topic, VirtualAgvAdapter } = createRequire(path.join(process.cwd(), "x"))("vda-5050-lib");

const RADIUS = 0.4, MAP = "map", ORDERS = 3;
// Each goes to and fro between its two ends, by way of the middle.
const VEHICLES = { east: [[0, 0], [5, 0], [10, 0]], north: [[5, -5], [5, 0], [5, 5]] };
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "pcr-others-"));
const programs = [];

function fail(why) {
  console.error(`others: ${why}`);
  end(1);
}
function end(status) {
  programs.forEach((program) => program.kill());
  fs.rmSync(folder, { recursive: true, force: true });
  process.exit(status);
}
process.on("unhandledRejection", (error) => fail(error.stack ?? error));
const sleep = (time) => new Promise((done) => setTimeout(done, time));

function freePort() {
  return new Promise((done) => {
    const server = net.createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });
}
async function reachable(port) {
  for (let k = 0; k < 500; k++) {
    const open = await new Promise((done) => {
      const socket = net.connect(port, "127.0.0.1", () => { socket.destroy(); done(true); }).on("error", () => done(false));
    });
    if (open) return;
    await sleep(20);
  }
  fail("mosquitto does not answer");
}

function order(name, trip) {
  const places = trip % 2 ? [...VEHICLES[name]].reverse() : VEHICLES[name];
  const id = (place) => `${place[0]},${place[1]}`;
  return {
    orderId: `${name} ${trip}`, orderUpdateId: 0,
    nodes: places.map((place, k) => ({
      nodeId: id(place), sequenceId: 2 * k, released: true, actions: [],
      nodePosition: { x: place[0], y: place[1], mapId: MAP },
    })),
    edges: places.slice(1).map((place, k) => ({
      edgeId: `e${k}`, sequenceId: 2 * k + 1, released: true, actions: [], startNodeId: id(places[k]), endNodeId: id(place),
    })),
  };
}

async function main(tool) {
  const port = await freePort();
  const config = path.join(folder, "mosquitto.conf");
  fs.writeFileSync(config, `listener ${port} 127.0.0.1\nallow_anonymous true\nlog_dest none\n`);
  const mosquitto = fs.existsSync("/usr/sbin/mosquitto") ? "/usr/sbin/mosquitto" : "mosquitto";
  programs.push(spawn(mosquitto, ["-c", config], { stdio: "ignore" }).on("error", (error) => fail(error)));
  await reachable(port);
  const known = Object.keys(VEHICLES).map((serialNumber) => (
    { manufacturer: "others", serialNumber, radius: RADIUS, margin: 0.1, speed: 2, acceleration: 2 }));
  const fleet = path.join(folder, "fleet.json");
  fs.writeFileSync(fleet, JSON.stringify({ vehicles: known }));
  const words = ["serve", "--journal", path.join(folder, "journal"), "--stay", "--broker", `127.0.0.1:${port}`, "--fleet", fleet];
  const serve = spawn(tool, words, { stdio: ["ignore", "inherit", "inherit"] });
  programs.push(serve.on("error", (error) => fail(error)).on("exit", (status) => fail(`pcr serve has ended: ${status}`)));

  const common = { vdaVersion: "2.0.0", transport: { brokerUrl: `mqtt://127.0.0.1:${port}` } };
  const agvs = {}, said = { waits: 0 };
  for (const [serialNumber, [[x, y]]] of Object.entries(VEHICLES)) {
    const agv = new AgvController({ manufacturer: "others", serialNumber }, { interfaceName: "uagv", ...common },
      { agvAdapterType: VirtualAgvAdapter, publishStateInterval: 500, publishVisualizationInterval: 100 },
      { initialPosition: { mapId: MAP, x, y, theta: 0, lastNodeId: "" }, tickRate: 20 });
    agvs[serialNumber] = agv;
    await agv.start();
    await agv.subscribe(Topic.Order, (told) => { said.waits += told.nodes.some((node) => node.released && node.nodeId.includes("+")); });
  }
  const master = new MasterController({ interfaceName: "fleet", ...common }, {});
  await master.start();

  let nearest = Infinity;
  setInterval(() => {
    const [a, b] = Object.values(agvs).map((agv) => agv._agvAdapter.vehicleState.position);
    nearest = Math.min(nearest, Math.hypot(a.x - b.x, a.y - b.y));
  }, 5);
  const drive = async (serialNumber) => {
    const agv = { manufacturer: "others", serialNumber };
    for (let trip = 0; trip < ORDERS; trip++) {
      for (let done = false, tries = 0; !done;) {
        if (++tries > 20) fail(`${serialNumber}: order ${trip} is not taken`);
        done = await new Promise((over) => {
          const onOrderProcessed = (error, byCancelation, active) => {
            // Not taken yet: nobody has said yet where it stands.
            if (error) { sleep(500).then(() => over(false)); } else if (!active) { over(true); }
          };
          master.assignOrder(agv, order(serialNumber, trip), { onOrderProcessed }).catch((error) => fail(error));
        });
      }
    }
  };
  setTimeout(() => fail("the orders are not done after 120 s"), 120e3);
  await sleep(1500);
  await Promise.all(Object.keys(VEHICLES).map(drive));
  console.log(`${2 * ORDERS} orders of vda-5050-lib are done; ${said.waits} of what was released ended before a crossing; nearest: ${nearest.toFixed(3)} m`);
  serve.removeAllListeners("exit");
  if (nearest < 2 * RADIUS) fail("the vehicles have touched");
  if (!said.waits) fail("nobody had to wait: it shows nothing");
  end(0);
}

if (process.argv.length !== 3) fail("node vda-5050-lib.js PCR");
main(process.argv[2]);
