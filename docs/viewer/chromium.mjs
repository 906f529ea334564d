// SPDX-License-Identifier: MIT
//
// Chromium without a window, which draws in software and asks the network for nothing. FOLDER has node_modules.

import { createRequire } from "node:module";
import { join, resolve } from "node:path";

export const startChromium = (folder, executablePath) =>
  createRequire(join(resolve(folder), "package.json"))("playwright-core").chromium.launch({
    executablePath,
    args: [
      "--no-sandbox",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist",
    ],
  });
