#include "reports/html/html_page.hpp"

namespace fieldproof::html {

// Colours are named once and mean a verdict everywhere: text in --c on its own tint. Neither '<'
// nor '&' may stand here.
const char* const html_style = R"css(
:root{color-scheme:light dark;--paper:#fff;--ink:#1b1f24;--soft:#59636e;--rule:#d8dee4;--tint:#f5f7f9;--link:#0757b3;
--good:#17703a;--good-tint:#e6f4ea;--bad:#b3201b;--bad-tint:#fdecea;--warn:#8a5a00;--warn-tint:#fff4d6;--cool:#3b5b8c;--cool-tint:#e8eef8;--hold:#6b3fa0;--hold-tint:#f2ebfa;--mark:#ffd9d6}
@media (prefers-color-scheme:dark){:root{--paper:#0f1318;--ink:#e4e8ed;--soft:#98a4b1;--rule:#2b333d;--tint:#171d24;--link:#79b4ff;
--good:#63cf8a;--good-tint:#12291b;--bad:#ff8a80;--bad-tint:#33171a;--warn:#e9b949;--warn-tint:#2f2611;--cool:#9db9e6;--cool-tint:#1a2536;--hold:#c6a4f2;--hold-tint:#271c36;--mark:#7a2620}}
*{box-sizing:border-box}
[hidden]{display:none!important}
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,"Segoe UI","Helvetica Neue",Arial,"Noto Sans CJK KR",sans-serif}
main{max-width:1120px;margin:0 auto;padding:20px 20px 60px}
h1{margin:0;font-size:30px;line-height:1.2}
h2{margin:40px 0 10px;font-size:20px}
h3{margin:26px 0 8px;font-size:16px;font-weight:600;overflow-wrap:anywhere}
p{margin:6px 0}
a{color:var(--link)}
small{display:block;color:var(--soft);font-size:12px;overflow-wrap:anywhere}
code,pre,.ids{font-family:ui-monospace,"DejaVu Sans Mono","Cascadia Mono",Consolas,monospace;font-size:12.5px}
code{overflow-wrap:anywhere}
em{color:var(--warn);font-style:normal}
summary{cursor:pointer}
table{border-collapse:collapse;width:100%}
th,td{padding:5px 10px 5px 0;text-align:left;vertical-align:top;font-weight:normal;overflow-wrap:anywhere}
thead th{color:var(--soft);font-size:12px;border-bottom:1px solid var(--rule);white-space:nowrap}
.num{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}

.v-pass,.v-info{--c:var(--good);--t:var(--good-tint)}
.v-fail,.v-xpass,.v-error{--c:var(--bad);--t:var(--bad-tint)}
.v-marginal,.v-non-strict,.v-xfail{--c:var(--warn);--t:var(--warn-tint)}
.v-blocked,.v-inconclusive{--c:var(--hold);--t:var(--hold-tint)}
.v-info{--c:var(--cool);--t:var(--cool-tint)}
.v-skip{--c:var(--soft);--t:var(--tint)}
.verdict{display:inline-block;padding:1px 7px;border-radius:4px;background:var(--t);color:var(--c);font-size:11.5px;font-weight:700;letter-spacing:.03em;white-space:nowrap}

.banner{padding:20px 24px;border-radius:10px;border-left:8px solid var(--c);background:var(--t)}
.banner.good{--c:var(--good);--t:var(--good-tint)}
.banner.bad{--c:var(--bad);--t:var(--bad-tint)}
.banner h1{color:var(--c)}
.banner .device{margin:0;color:var(--soft);overflow-wrap:anywhere}
.banner .detail{margin:4px 0 0;font-size:17px}
.bar{display:flex;height:10px;margin:14px 0;gap:2px}
.bar span{min-width:4px;background:var(--c);border-radius:2px}
.tiles{display:flex;flex-wrap:wrap;gap:10px;margin:0 0 18px;padding:0;list-style:none}
.tiles li{flex:1 1 150px;max-width:270px;padding:8px 12px;border:1px solid var(--rule);border-radius:8px}
.tiles .link{cursor:pointer}
.tiles .link:hover{border-color:var(--c)}
.tiles b{margin-right:8px;color:var(--c);font-size:22px;font-variant-numeric:tabular-nums}
.columns{display:grid;grid-template-columns:1fr 1fr;gap:0 40px}
.facts{height:max-content}
.wide th{width:170px!important}
.facts th{width:130px;color:var(--soft)}
.facts tr{border-bottom:1px solid var(--rule)}
nav{display:flex;flex-wrap:wrap;gap:4px 18px;margin-top:18px}

#find{display:flex;flex-wrap:wrap;gap:8px;align-items:center;margin:24px 0 8px}
#find input,#find select,button{font:inherit;font-size:14px;padding:6px 9px;border:1px solid var(--rule);border-radius:6px;background:var(--paper);color:var(--ink)}
#find input{flex:3 1 260px;min-width:0}
#find select{flex:1 1 130px;min-width:0;max-width:220px}
#find output{color:var(--soft);font-size:14px}
button{cursor:pointer}
.found{table-layout:fixed;font-size:13px}
.found td{border-bottom:1px solid var(--rule)}
.found th button{padding:0;border:0;background:none;color:inherit;font-size:12px}
.found th:nth-child(1){width:124px}
.found th:nth-child(2){width:30%}
.found th:nth-child(3){width:20%}
.found th:nth-child(5){width:80px;text-align:right}
.found td:last-child{text-align:right;font-variant-numeric:tabular-nums}
.found [aria-sort=ascending]::after{content:" \25B2"}
.found [aria-sort=descending]::after{content:" \25BC"}
.seen{outline:3px solid var(--link);outline-offset:2px}

.cause>h3 .times{color:var(--bad)}
.case{margin:8px 0;border:1px solid var(--rule);border-left:4px solid var(--c);border-radius:6px;padding:0 14px}
.case summary{padding:8px 0;overflow-wrap:anywhere}
.case[open]{padding-bottom:12px}
.message{display:block;padding-left:20px;color:var(--c)}
.clause .of{margin-left:8px}
.clause q{display:block;margin-top:2px;padding-left:12px;border-left:3px solid var(--rule);color:var(--soft)}
.monitor,.differences{margin:12px 0}
.monitor td,.differences td{border-bottom:1px solid var(--rule)}
.differences{width:auto}
.differences td:first-child{overflow-wrap:break-word}
.differences td:nth-child(2){color:var(--good)}
.differences td:nth-child(3){color:var(--bad)}
.monitor th:nth-child(-n+2),.monitor .num{width:86px;text-align:right}
.monitor .way{width:84px;text-align:center;color:var(--soft);white-space:nowrap}
.monitor td{font-size:13px}
.monitor code{display:block}
.monitor .notation{white-space:pre-wrap}
.monitor .hex{color:var(--soft)}
.monitor .note .notation{color:var(--soft);font-style:italic}
.monitor .expected{background:var(--good-tint)}
.monitor .judged{background:var(--bad-tint)}
.monitor .judged .hex,.monitor .expected .hex{color:inherit}
mark{padding:0 1px;border-radius:2px;background:var(--mark);color:inherit;font-weight:700}
.remarks{margin:8px 0;padding-left:18px;color:var(--soft)}
.remarks b{color:var(--ink);font-weight:600}
.replay{margin:8px 0 0;padding:8px 10px;border-radius:6px;background:var(--tint);white-space:pre-wrap;overflow-wrap:anywhere}

.matrix{border-top:1px solid var(--rule)}
.matrix .head,.section>summary{display:grid;grid-template-columns:minmax(120px,1fr) repeat(var(--columns),84px);align-items:center}
.matrix .head{padding-top:14px;color:var(--soft);border-bottom:1px solid var(--rule)}
.matrix .head .name{color:var(--ink);font-size:14px;font-weight:600}
.matrix .head span,.section>summary span{padding:2px 6px;text-align:right;font-size:14px}
.matrix .head span{font-size:10.5px}
.matrix .head .name,.section>summary .name{text-align:left}
.name i{margin-left:10px;color:var(--soft);font-style:normal;font-size:13px}
.section{border-bottom:1px solid var(--rule)}
.section>summary:hover{background:var(--tint)}
.section>summary .name::before{content:"\25B8";display:inline-block;width:16px;color:var(--soft)}
.section[open]>summary .name::before{content:"\25BE"}
.section>summary span[data-verdict]{color:var(--c);font-weight:600;font-variant-numeric:tabular-nums}
.section>summary .none{color:var(--soft);font-weight:400}
.section .case{margin-left:16px}
.lines,.passes{margin:0 0 10px 16px;width:calc(100% - 16px);font-size:13px}
.lines td:first-child{width:110px}
.lines th{width:38%}
.passes{table-layout:fixed;font:12px/1.45 ui-monospace,"DejaVu Sans Mono",Consolas,monospace}
.passes th{width:34%}
.passes td:last-child{width:90px;text-align:right;color:var(--soft)}
.cut{margin-left:16px;color:var(--warn)}

.timing .plot{width:42%;padding-right:16px}
.timing svg{display:block;width:100%;overflow:visible}
.timing text{fill:var(--soft);font-size:10px}
.timing td{vertical-align:middle;border-bottom:1px solid var(--rule)}
.bars{fill:var(--link);opacity:.75}
.box{stroke:var(--ink);stroke-width:2}
.median{stroke:var(--ink);stroke-width:2}
.grid{stroke:var(--rule)}
.limit{stroke:var(--bad);stroke-width:1.5;stroke-dasharray:4 3}

.trace{max-width:760px;margin:10px 0}
.trace svg{display:block;width:100%;overflow:visible;fill:var(--ink);font:12px system-ui,"Segoe UI",Arial,sans-serif}
.trace .x,.trace .y,.trace .at{fill:var(--soft)}
.trace .x{text-anchor:middle}
.trace .y{text-anchor:end}
.trace polyline{fill:none;stroke:var(--a);stroke-width:1.8;stroke-linejoin:round}
.trace .mark{stroke:var(--soft);stroke-dasharray:1 3}
.trace .on{fill:var(--bad);opacity:.08}
.trace figcaption{color:var(--soft);font:12.5px/1.5 system-ui,"Segoe UI",Arial,sans-serif}
.trace figcaption b{margin-right:6px;padding-left:6px;border-left:12px solid var(--a);color:var(--ink)}
.trace ol{columns:2 240px;column-gap:44px;margin:4px 0;padding-left:28px}
.had,.carried{stroke:var(--link);stroke-width:16}
.had{opacity:.3}
.a0{--a:#3b82d6}.a1{--a:#d9822b}.a2{--a:#17988f}.a3{--a:#9a5fd0}.a4{--a:#d24d8a}.a5{--a:#84931f}

.wire{margin:12px 0}
.wire.narrow{display:none}
.wire svg{display:block;width:100%;max-width:900px;font:11px system-ui,"Segoe UI",Arial,sans-serif;fill:var(--soft)}
.wire .lane{font-weight:600}
.wire .rail{stroke:var(--rule)}
.wire .bar{height:20px;margin:0;stroke:var(--paper)}
.wire .sent{fill:var(--link)}
.wire .received{fill:var(--soft)}
.wire .surplus{fill:var(--warn)}
.wire .judged{fill:var(--bad)}
.wire .opened{fill:var(--paper);stroke:var(--soft);stroke-width:2}
.wire .ended{fill:var(--soft)}
.wire .due{fill:var(--bad);opacity:.07}
.wire .limit-text,.wire .over{fill:var(--bad)}
.wire .silence,.wire .tick,.wire .cut{text-anchor:middle;font-variant-numeric:tabular-nums}
.wire .cut{font-size:15px}
.wire .last{text-anchor:end}
.wire .unit{text-anchor:end;font-size:10px}

.unjudged .num{width:90px;color:var(--c);font-weight:600}
.reason{margin:4px 0 4px 16px;font-size:13px;overflow-wrap:anywhere}
.reason .ids{display:block}
.list td,.list th{border-bottom:1px solid var(--rule)}
.scroll{overflow-x:auto}
.scroll .list th:first-child{min-width:160px}
.list .num{padding-right:20px}
.ids{color:var(--soft);overflow-wrap:anywhere}
.errata th{width:200px}
.errata td:last-child{width:110px}
.legend{padding:0;list-style:none}
.legend li{margin:4px 0}
.legend .verdict{min-width:112px;text-align:center;margin-right:6px}
.sheet{margin-top:50px;padding-top:30px;border-top:3px solid var(--ink)}
.sheet .banner{margin-top:16px}
.signatures{display:grid;grid-template-columns:1fr 1fr;gap:40px;margin-top:40px;break-inside:avoid}
.parts td:nth-child(-n+2){white-space:nowrap}
.parts td:nth-child(3){color:var(--soft)}
.signatures p{margin:0;padding-top:34px;border-bottom:1px solid var(--ink);color:var(--soft)}

@media screen and (max-width:960px){
.matrix .head{display:block}
.matrix .head span:not(.name){display:none}
.section>summary{display:flex;flex-wrap:wrap}
.section>summary .none{display:none}
.section>summary .name{flex:1 1 100%}
.section>summary span[data-verdict]::after{content:" " attr(data-verdict);font-size:11px;font-weight:400}
}
@media screen and (max-width:720px){
main{padding:12px 12px 40px}
h1{font-size:24px}
.columns{grid-template-columns:1fr}
.tiles li{flex-basis:42%;max-width:none}
#find select{max-width:none;flex-basis:45%}
.found thead tr{display:flex;gap:14px}
.found thead th:nth-child(n){width:auto}
.found,.found tbody,.found tbody tr,.found td,.list,.list tbody,.list tr,.list td,.list th,.passes,.passes tbody,.passes tr,.passes th,.passes td,.lines,.lines tbody,.lines tr,.lines th,.lines td{display:block;width:auto!important;padding:0}
.passes tr,.lines tr,.found tr,.list tr{padding:6px 0;border-bottom:1px solid var(--rule)}
.list thead{display:none}
.list td,.list th,.found td{border:0}
.list .num{text-align:left}
.passes td:last-child,.found td:last-child{text-align:left}
.monitor thead{display:none}
.monitor tr{display:grid;grid-template-columns:auto auto 1fr;border-bottom:1px solid var(--rule)}
.monitor td{border:0;width:auto!important;text-align:left!important}
.monitor td:last-child{grid-column:1/-1;padding-top:0}
.timing th:nth-child(3),.timing td:nth-child(3),.timing th:nth-child(4),.timing td:nth-child(4),.timing th:nth-child(n+6),.timing td:nth-child(n+6){display:none}
.timing .plot{width:44%}
.timing td{font-size:12.5px}
.facts th{width:100px}
.trace svg{font-size:18px}
}
@media screen and (max-width:560px){
.wire{display:none}
.wire.narrow{display:block}
}
@media print{
:root{--paper:#fff;--ink:#000;--soft:#444;--rule:#bbb;--tint:#f4f4f4;--good:#17703a;--good-tint:#eef7f0;--bad:#b3201b;--bad-tint:#fdf0ef;--warn:#8a5a00;--warn-tint:#fff8e6;--cool:#3b5b8c;--cool-tint:#eef2f9;--hold:#6b3fa0;--hold-tint:#f6f1fb;--mark:#ffd9d6;--link:#0757b3}
*{print-color-adjust:exact}
body{font-size:9pt;line-height:1.4}
h1{font-size:17pt}
h2{font-size:12pt;margin-top:22px}
th,td{padding-top:3px;padding-bottom:3px}
.banner{padding:10px 16px}
.tiles{gap:6px}
.tiles li{flex-basis:120px;padding:4px 8px}
.tiles b{font-size:13pt}
small,.verdict{font-size:7.5pt}
code,pre,.ids,.monitor td{font-size:8pt}
.facts th{width:90px}
main{max-width:none;padding:0}
nav,#find,.found,#more{display:none}
main:has(>.sheet)>:not(.sheet){display:none}
h1,h2,h3,thead tr,tbody tr:first-child,tbody tr:nth-last-child(2){break-after:avoid}
h1,h2,h3,p{orphans:3;widows:3}
tr,.tiles li,.section>summary,.banner,.facts,.signatures{break-inside:avoid}
.case::details-content{content-visibility:visible;display:block;height:auto}
.section .case::details-content{content-visibility:hidden}
.sheet{border:0;margin:0;padding:0}
.sheet .bar,.sheet .tiles small{display:none}
.sheet .tiles{margin-top:10px}
.one-line td{white-space:nowrap}
.one-line td:last-child{width:100%}
.sheet .page{break-before:page;margin-top:0}
.list details::details-content{content-visibility:visible;display:block}
}
@page{margin:15mm 14mm;@bottom-right{content:counter(page) " / " counter(pages);font-size:9pt}}
)css";

}  // namespace fieldproof::html
