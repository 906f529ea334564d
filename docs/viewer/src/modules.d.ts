// SPDX-License-Identifier: MIT
declare module "predicate.wasm" {
  const code: Uint8Array;
  export default code;
}
