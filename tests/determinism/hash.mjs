// Prints the hash of all fits as the core has it in WebAssembly, and fails where it is not the pinned one.
// Run it by `node hash.mjs shadowfit_determinism.wasm`; `cargo xtask ci` does.
import { readFileSync } from 'node:fs';

const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), {});
const [hash, expected] = [instance.exports.shadowfit_hash(), instance.exports.shadowfit_expected_hash()];
const hex = (value) => `0x${BigInt.asUintN(64, value).toString(16)}`;
if (hash !== expected) {
    console.error(`the fits' hash is ${hex(hash)} in WebAssembly, but ${hex(expected)} elsewhere`);
    process.exit(1);
}
console.log(`the fits' hash is ${hex(hash)} in WebAssembly too`);
